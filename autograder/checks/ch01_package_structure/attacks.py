"""Attacks on 01: set-up files that steal and forge, and tests that always fail or report the reference."""

from __future__ import annotations

from pathlib import Path

from autograder.checking.attacks import (
    BLOCK_REPORT,
    FORGE_NAMED_REPORT,
    FORGE_REPORT,
    STEAL_SECRETS,
    TELL_ALL,
    Attack,
    Chapter,
)
from autograder.checking.probes import imports

CHAPTER = Chapter("01_package_structure")
SETUP, TESTS = "square_dance/setup.py", "square_dance/test"
PLANTED_FILES = {
    "square_dance/pytest.ini": "[pytest]\naddopts = --collect-only\n",
    "../install/square_dance/share/square_dance/launch/square_dance.launch.py": "forged = True\n",
    "../install/square_dance/lib/square_dance/dancer": "#!/bin/sh\necho forged\n",
}
FAIL_ALWAYS = "# Copyright 2026 The ROS 2 Python Course Authors\n" + "\n\n".join(
    f"def test_{name}():\n    assert False\n"
    for name in (
        "four_sides_and_four_turns_come_back_to_the_start",
        "it_drives_straight_first_and_then_turns_to_the_left",
    )
)
TELL_REFERENCE = (
    TELL_ALL
    + """
import inspect

from square_dance.nodes import dancer
from square_dance.utils import steps

TestReference = tell(inspect.getsource(steps) + inspect.getsource(dancer))
"""
)


def _write_long_files(folder: Path) -> None:
    """Write packages that declare no dependency, and make each file with imports too large to search."""
    CHAPTER.write()(folder)
    for package in (folder / "src").iterdir():
        manifest = package / "package.xml"
        lines = manifest.read_text().splitlines(keepends=True)
        manifest.write_text("".join(line for line in lines if "depend>" not in line))
        for file in package.rglob("*.py"):
            if "import " in (text := file.read_text()) and file.name != "setup.py":
                file.write_text(text + "\n" * imports.MAX_BYTES)


def _write_hidden_copy(folder: Path) -> None:
    """Write a package that lists its files by hand, and hide the reference in a folder that colcon ignores."""
    CHAPTER.write("files_by_hand")(folder)
    CHAPTER.write()(folder / "src/zz")
    (folder / "src/zz/COLCON_IGNORE").touch()


def attacks() -> tuple[Attack, ...]:
    """Return the attacks on the chapter."""
    pytest_checks, launch_checks = CHAPTER.mutant("pytest_unnamed").fails, CHAPTER.mutant("launch_not_installed").fails
    return (
        Attack(
            "package thief",
            "setup.py steals; a pytest.ini, and a forged install tree with the file that setup.py does not install",
            CHAPTER.write("launch_not_installed", heads={SETUP: STEAL_SECRETS}, files=PLANTED_FILES),
            launch_checks,
            exactly=True,
            says="share/square_dance/launch/square_dance.launch.py was not installed",
        ),
        Attack(
            "package behind the package",
            "a correct package of the same name, in a folder that colcon ignores and that the checks might read",
            _write_hidden_copy,
            CHAPTER.mutant("files_by_hand").fails,
            exactly=True,
        ),
        Attack(
            "report by set-up",
            "setup.py does not name pytest, and writes the report that pytest would write",
            CHAPTER.write("pytest_unnamed", heads={SETUP: FORGE_REPORT}),
            pytest_checks,
            exactly=True,
            says="`colcon test` does not run pytest for this package",
        ),
        Attack(
            "report with the run's name",
            "setup.py does not name pytest, and writes the report with the name that this run gives it",
            CHAPTER.write("pytest_unnamed", heads={SETUP: FORGE_NAMED_REPORT}),
            pytest_checks,
            exactly=True,
            says="`colcon test` does not run pytest for this package",
        ),
        Attack(
            "report in the way",
            "setup.py puts a folder where colcon test writes its report",
            CHAPTER.write("pytest_unnamed", heads={SETUP: BLOCK_REPORT}),
            pytest_checks,
            says="`colcon test` does not run pytest for this package",
        ),
        Attack(
            "names in the way",
            "a folder with the name of a file that the checks add, and a manifest with an unknown encoding",
            CHAPTER.write(
                swaps={"wall_alarm/package.xml": ('<?xml version="1.0"?>', '<?xml version="1.0" encoding="foo"?>')},
                files={f"{TESTS}/__init__.py/note.txt": ""},
            ),
            frozenset({"grows", "tests_stay"}),
        ),
        Attack(
            "long files",
            "packages that declare no dependency, with files that are too large to search for imports",
            _write_long_files,
            frozenset({"run_dependencies", "launch_dependencies", "test_dependencies", "alarm_dependencies"}),
            says="is larger than 256 KiB",
        ),
        Attack(
            "telltale given tests",
            "the given tests put the text of the reference, on which they are run, into every part of their report",
            CHAPTER.write(files={f"{TESTS}/test_steps.py": TELL_REFERENCE}),
            frozenset({"given_tests"}),
            says="on a correct square_dance, and test_flake8 and a test failed",
        ),
        Attack(
            "tests that always fail",
            "the given tests fail on every version of the package, correct or faulty",
            CHAPTER.write(files={f"{TESTS}/test_steps.py": FAIL_ALWAYS}),
            frozenset({"given_tests"}),
            exactly=True,
            says="on a correct square_dance, and test_four_sides_and_four_turns_come_back_to_the_start",
        ),
    )
