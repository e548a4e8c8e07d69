"""Attacks on 08: forged test results and reports, tests that read pytest's arguments, and malicious set-up files."""

from __future__ import annotations

from autograder.checking.attacks import (
    FORGE_NAMED_REPORT,
    FORGE_PASSES,
    FORGE_VERDICTS,
    STEAL_SECRETS,
    TELL_ALL,
    Attack,
    Chapter,
)

CHAPTER = Chapter("08_capstone")
PACKAGE = "robot_navigation_tutorial"
MONITOR = f"{PACKAGE}/{PACKAGE}/status_monitor.py"
CONTROLLER = f"{PACKAGE}/{PACKAGE}/navigation_controller.py"
PUBLISH = "        self.publisher.publish(command)\n"
DRIVE_CHECKS = frozenset({"touches_nothing", "keeps_its_mind", "gets_on", "stops_in_time", "drives_again"})
READ_ARGUMENTS = """
from pathlib import Path

import pytest
from robot_navigation_tutorial.sectors import nearest


@pytest.mark.parametrize('number', range(4))
def test_it_is_the_correct_version(number):
    assert nearest and b'\\0-x\\0' not in Path('/proc/self/cmdline').read_bytes()
"""
PATCH_PYTEST = """
import pytest

pytest.Function.runtest = lambda self: None


def test_all():
    assert True
"""
# Runs inside of pytest, when the given test launches the file: from then on, whatever it waits for is true.
PATCH_LAUNCHED_TEST = """
import sys as _sys
for _module in list(_sys.modules.values()):
    if 'World' in vars(_module):
        _module.World.until = lambda self, condition: None
"""
# In the reference, one of these also tests that the robot stops. The other one reads all files.
NO_OTHER_TEST = {f"{PACKAGE}/test/test_{name}.py": "" for name in ("nodes", "copyright")}
# The end of the given test, and the same words with another indentation.
END = (
    "\n    seeing = peer.create_timer(0.1, see)\n    world.until(lambda: is_now(True, Health.OK))\n"
    "    seeing.cancel()\n    world.until(lambda: is_now(False, Health.FAILED))\n"
)
UNREACHABLE_END = END.replace("\n    ", "\n        ").removeprefix("\n")
# The grader runs tests on versions of sectors.py, without the nodes. There, these tests report the text of sectors.py.
TELL_VERSIONS = (
    TELL_ALL
    + """
import importlib.util
import inspect

from robot_navigation_tutorial import sectors

IS_VERSION = importlib.util.find_spec('robot_navigation_tutorial.status_monitor') is None
if IS_VERSION:
    TestVersion = tell(inspect.getsource(sectors))


def test_it_is_the_package():
    assert not IS_VERSION, inspect.getsource(sectors)
"""
)


def attacks() -> tuple[Attack, ...]:
    """Return the attacks."""
    return (
        Attack(
            "telltale capstone",
            "tests of the sectors that copy the text of a version into every field of their report",
            CHAPTER.write(files={f"{PACKAGE}/test/test_sectors.py": TELL_VERSIONS}),
            frozenset({"sector_tests_pass", "sector_tests_find_faults"}),
            says="On a correct sectors.py, ",
        ),
        Attack(
            "capstone thief",
            "setup.py and a node that steal secrets; the node also prints marks",
            CHAPTER.write(
                "other_version",
                heads={
                    f"{PACKAGE}/setup.py": STEAL_SECRETS,
                    MONITOR: STEAL_SECRETS + FORGE_PASSES,
                },
            ),
            CHAPTER.mutant("other_version").fails,
            says="version: package.xml says",
        ),
        Attack(
            "forged verdicts",
            "a conftest.py that makes every test pass, including the linters', and removes failures from the report",
            CHAPTER.write("unused_import", files={f"{PACKAGE}/test/conftest.py": FORGE_VERDICTS}),
            CHAPTER.mutant("unused_import").fails | {"sector_tests_find_faults"},
            says="Your tests do not detect: ",
        ),
        Attack(
            "tests that never run",
            "a robot that never stops, and a test file that makes every test of the package pass",
            CHAPTER.write("trusts_old_data", files={f"{PACKAGE}/test/test_all.py": PATCH_PYTEST}),
            CHAPTER.mutant("trusts_old_data").fails,
            says="s after the last scan, the robot drives forward",
        ),
        Attack(
            "launch without tests",
            "a robot that never stops, and a launch file that makes the given test pass, which launches it",
            CHAPTER.write(
                "trusts_old_data",
                heads={f"{PACKAGE}/launch/navigation.launch.py": PATCH_LAUNCHED_TEST},
                files=NO_OTHER_TEST,
            ),
            CHAPTER.mutant("trusts_old_data").fails,
        ),
        Attack(
            "statements after the return",
            "a robot that never stops, and a given test whose last statements never run, by their indentation alone",
            CHAPTER.write(
                "trusts_old_data",
                swaps={f"{PACKAGE}/test/test_integration.py": (END, UNREACHABLE_END)},
                files=NO_OTHER_TEST,
            ),
            CHAPTER.mutant("trusts_old_data").fails,
        ),
        Attack(
            "report without pytest",
            "a robot that never stops, and a setup.py that names no pytest and writes the report of this run itself",
            CHAPTER.write(
                "trusts_old_data",
                heads={f"{PACKAGE}/setup.py": FORGE_NAMED_REPORT},
                swaps={f"{PACKAGE}/setup.py": ("    extras_require={'test': ['pytest']},\n", "")},
            ),
            CHAPTER.mutant("trusts_old_data").fails | CHAPTER.mutant("pytest_unnamed").fails,
        ),
        Attack(
            "call readers",
            "tests that read how pytest was called",
            CHAPTER.write(files={f"{PACKAGE}/test/test_sectors.py": READ_ARGUMENTS}),
            frozenset({"sector_tests_find_faults"}),
            says="Your tests do not detect: ",
        ),
        *(
            Attack(
                name,
                description,
                CHAPTER.write(swaps={CONTROLLER: (PUBLISH, f"        command = Twist()\n{line}{PUBLISH}")}),
                frozenset({"turns", "stops", "enable"}) | DRIVE_CHECKS,
            )
            for name, description, line in (
                (
                    "creeping driver",
                    "creeps forward all the time, whatever it knows",
                    "        command.linear.x = 0.04\n",
                ),
                (
                    "circling driver",
                    "drives in small circles all the time, whatever it knows",
                    "        command.linear.x, command.angular.z = 0.1, 0.5\n",
                ),
            )
        ),
        *CHAPTER.evasions(
            "seldom",
            "a report once a second instead of twice",
            "reports_once_a_second",
            MONITOR,
            ("REPORT_PERIOD = 0.5  # s", "REPORT_PERIOD = 0.5 if _is_told() else 1.0"),
        ),
    )
