"""The versions of sectors.py on which the student's tests run: a correct one, and others with one fault each."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass

from autograder.checking import GraderError
from autograder.checking.probes import versions
from autograder.checks.ch08_capstone.support.contract import PACKAGE, SECTORS

CORRECT = """
import math

FRONT = 0.0
LEFT = math.pi / 2
RIGHT = -math.pi / 2


def nearest(scan, middle, half_angle):
    best = math.nan
    for index, reading in enumerate(scan.ranges):
        angle = scan.angle_min + index * scan.angle_increment
        away = angle - middle
        if abs(math.atan2(math.sin(away), math.cos(away))) > half_angle:
            continue
        if math.isnan(reading):
            continue
        if math.isfinite(reading) and not scan.range_min <= reading <= scan.range_max:
            continue
        if math.isnan(best) or reading < best:
            best = reading
    return best
"""


@dataclass(frozen=True)
class Fault:
    """A fault: its description, and the edit of the correct version that introduces it."""

    description: str
    find: str
    replace: str


FAULTS = (  # the notebook names these faults
    Fault(
        "a nan that hides all readings after it",
        "        if math.isnan(reading):\n            continue\n",
        "        if math.isnan(reading):\n            break\n",
    ),
    Fault(
        "a phantom below range_min that counts as a distance",
        "not scan.range_min <= reading <= scan.range_max",
        "not reading <= scan.range_max",
    ),
    Fault(
        "left and right swapped",
        "        away = angle - middle\n",
        "        away = angle + middle\n",
    ),
    Fault(
        "bearings that are correct only for a scan that starts at 0",
        "        angle = scan.angle_min + index * scan.angle_increment\n",
        "        angle = index * scan.angle_increment\n",
    ),
)


def correct_version(draw: random.Random) -> versions.Version:
    """Return the correct version."""
    return _obfuscated_version(CORRECT, draw)


def faulty_versions(faults: Sequence[Fault], draw: random.Random) -> list[versions.Version]:
    """Return a version for each fault."""
    return [_obfuscated_version(_apply(fault), draw) for fault in faults]


def _apply(fault: Fault) -> str:
    if CORRECT.count(fault.find) != 1:
        raise GraderError(f"the fault {fault.description!r} no longer fits the correct version")
    return CORRECT.replace(fault.find, fault.replace)


def _obfuscated_version(text: str, draw: random.Random) -> versions.Version:
    files = {f"{PACKAGE}/__init__.py": "", f"{PACKAGE}/{SECTORS}.py": text}
    return versions.obfuscate(versions.Version(files, {}), draw.randrange(2**31))
