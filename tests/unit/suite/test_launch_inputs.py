"""The hidden inputs of the launch chapter: drawn from the seed, written into the student's parameters file."""

from __future__ import annotations

import random

from autograder.checks.ch04_launch.hidden.inputs import draw_inputs, with_values

FILE = """# speed: of the robot
/**/driver:
  ros__parameters:
    speed: 0.2  # m/s
    turn_rate: -1e-1
other:
  ros__parameters: {depth: 3}
"""


def test_numbers_are_replaced_in_place_and_all_else_is_unchanged() -> None:
    assert with_values(FILE, {"speed": 0.7, "turn_rate": -0.5, "absent": 9.0}) == FILE.replace(
        "speed: 0.2", "speed: 0.7"
    ).replace("-1e-1", "-0.5")


def test_the_same_seed_gives_the_same_inputs_and_another_seed_gives_others() -> None:
    assert draw_inputs(random.Random("7")) == draw_inputs(random.Random("7"))
    assert draw_inputs(random.Random("7")) != draw_inputs(random.Random("8"))


def test_inputs_differ_from_the_defaults_that_they_must_override() -> None:
    for seed in range(200):
        inputs = draw_inputs(random.Random(seed))
        assert inputs.speed != 0.2
        assert inputs.file_values["speed"] not in (inputs.speed, 0.2)
        assert inputs.file_values["turn_rate"] != 0.4
        assert inputs.file_values["report_period"] != 0.5
        assert len({*inputs.names, "robot1", "robot2"}) == 4
        assert inputs.low_battery < 20.0 < inputs.sufficient_battery
        assert inputs.whole_battery > 20
