"""Hidden inputs: the values in the parameters file, and the arguments of the launches."""

from __future__ import annotations

import random
import re
from dataclasses import dataclass

NAMES = ("alba", "bruno", "cleo", "dora", "emil", "fritz", "gina", "hugo")


@dataclass(frozen=True)
class Inputs:
    """The inputs of one grading.

    Attributes:
        file_values: the values in the parameters file, by name.
        speed: a robot's speed in m/s, with a fraction.
        whole_speed: a robot's speed in m/s, without a decimal point.
        number_name: a robot's name that looks like a number.
        quoted_name: a robot's name with quotation marks of both kinds, and other characters special to YAML or Python.
        names: the names of two robots.
        sufficient_battery: a battery level that passes the self-test, in percent, with a fraction.
        whole_battery: another battery level that passes the self-test, without a decimal point.
        low_battery: a battery level that fails the self-test.
        invalid_reports: texts for the argument report that are neither true nor false; some conditions accept them.
    """

    file_values: dict[str, float]
    speed: float
    whole_speed: int
    number_name: str
    quoted_name: str
    names: tuple[str, str]
    sufficient_battery: float
    whole_battery: int
    low_battery: float
    invalid_reports: tuple[str, ...]


def draw_inputs(draw: random.Random) -> Inputs:
    """Draw the inputs of one grading."""
    first, second = draw.sample(NAMES, 2)
    return Inputs(
        file_values={
            "speed": round(draw.uniform(0.5, 0.9), 3),
            "turn_rate": round(draw.uniform(-0.9, -0.1), 3),
            "report_period": round(draw.uniform(0.2, 0.4), 3),
        },
        speed=round(draw.uniform(0.21, 0.45), 3),
        whole_speed=draw.randint(1, 3),
        # Not 1e3 or 08: launch_ros writes them without quotation marks, and rcl reads them as numbers.
        number_name=draw.choice(("{}", "{}.50")).format(draw.randint(10, 99)),
        quoted_name=rf"""{first}'s "R{draw.randint(2, 9)}": robot #{draw.randint(2, 9)}, [a] {{b}} \n""",
        names=(first, second),
        sufficient_battery=draw.randint(21, 98) + 0.5,
        whole_battery=draw.randint(21, 98),
        low_battery=draw.randint(1, 18) + 0.5,
        invalid_reports=("maybe", draw.choice(("1", "0")), draw.choice(("True", "TRUE", "False"))),
    )


def with_sim_time(text: str) -> str:
    """Return a parameters file that also sets use_sim_time, which every node has, for driver and reporter."""
    return re.sub(r"(?m)^([ \t]+)(?=(?:turn_rate|report_period):)", r"\1use_sim_time: true\n\1", text)


def with_values(text: str, values: dict[str, float]) -> str:
    """Return a parameters file with other numbers; parameters that it does not contain are not added."""
    for name, value in values.items():
        text = re.sub(rf"(?m)^([ \t]+{name}:[ \t]*)[-+.\deE]+", rf"\g<1>{value}", text)
    return text
