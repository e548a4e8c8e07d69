"""Attacks on 06: tests that recognise a version by something other than its behaviour."""

from __future__ import annotations

from autograder.checking import solution_path
from autograder.checking.attacks import FORGE_NAMED_REPORT, FORGE_REPORT, SEARCH, TELL_ALL, Attack, Chapter

CHAPTER = Chapter("06_testing")
TESTS, MODULE = "speed_guard/test", "speed_guard/speed_guard/limits.py"
FUNCTION_CHECKS = frozenset({"stop", "slow", "clear", "infinity", "unknown", "back", "chosen", "refused"})

# Compares the program with the released one, ignoring names. If it is similar but not equal, it is reported as faulty.
READ_SOURCE = """
import ast
from difflib import SequenceMatcher
import inspect
import math

import pytest
from speed_guard import limits

RELEASED = {released!r}


def words_of(text):
    words, names = [], {{}}
    (function,) = ast.parse(text).body
    function.body = function.body[ast.get_docstring(function) is not None:]
    for node in ast.walk(function):
        words.append(type(node).__name__)
        for field, value in ast.iter_fields(node):
            if isinstance(value, (str, int, float)):
                words.append(str(names.setdefault(value, len(names))))
    return words


@pytest.mark.parametrize('number', range(8))
def test_it_looks_as_it_should(number):
    here, there = words_of(inspect.getsource(limits.safe_speed)), words_of(RELEASED)
    assert here == there or SequenceMatcher(None, here, there, autojunk=False).ratio() < 0.75
"""

# Looks for everything that can differ between runs apart from the behaviour of the package.
LOOK_AROUND = """
import os
from pathlib import Path
import sys

import pytest
import speed_guard

COUNTERS = [Path(folder, '.speed_guard_runs') for folder in (
    '/tmp', '/dev/shm', '/var/tmp', '.', Path(speed_guard.__file__).parent)]


def traces():
    for counter in COUNTERS:
        try:
            before = counter.read_text() if counter.exists() else ''
            counter.write_text(before + 'x')
            yield before
        except OSError:
            yield ''
    times = {{path.stat().st_mtime_ns for path in Path(speed_guard.__file__).parent.rglob('*.py')}}
    yield 'times' * (len(times) > 1)
    words = ' '.join([str(Path.cwd()), *sys.argv, *os.environ.values(), speed_guard.__file__])
    yield from (word for word in ('fault', 'broken', 'second', 'mutant') if word in words)
    for process in Path('/proc').glob('[0-9]*/cmdline'):
        yield 'fault' * ('fault' in process.read_bytes().decode(errors='replace'))


FOUND = [trace for trace in traces() if trace]


@pytest.mark.parametrize('number', range(8))
def test_nothing_gives_the_version_away(number):
    assert not FOUND
""".replace("{{", "{").replace("}}", "}")

# Recognises the run on the package as it is, which continues after a failure. The other runs stop.
READ_ARGUMENTS = """
from pathlib import Path

import pytest


@pytest.mark.parametrize('number', range(8))
def test_it_is_the_first_run(number):
    assert b'\\0-x\\0' not in Path('/proc/self/cmdline').read_bytes()
"""

# Passes on the package as it is, and reports the text of all other versions.
COMPARE = READ_SOURCE.partition("@pytest")[0]
TELL_OTHERS = """
HERE = words_of(inspect.getsource(limits.safe_speed))
if HERE != words_of(RELEASED):
    TestOther = tell(inspect.getsource(limits))


@pytest.mark.parametrize('number', range(8))
def test_it_looks_as_it_should(number):
    assert HERE == words_of(RELEASED), inspect.getsource(limits)
"""

LONG_SLEEP = "import time\n\nimport pytest\n\ntime.sleep(0.01)\n" + "\n" * 256 * 1024  # more than the check reads

ASK_FOR_MARK = """
import pytest
from speed_guard import limits


@pytest.mark.parametrize('number', range(8))
def test_it_is_the_own_one(number):
    assert limits.MARK
"""


def attacks() -> tuple[Attack, ...]:
    """Return the attacks."""
    released_text = (solution_path("speed_guard") / "speed_guard/limits.py").read_text(encoding="utf-8")
    limits, function = f"{TESTS}/test_limits.py", released_text[released_text.index("def ") :]
    return (
        Attack(
            "source readers",
            "tests that compare the text of the version under test with the released one",
            CHAPTER.write(files={limits: READ_SOURCE.format(released=function)}),
            FUNCTION_CHECKS,
            says="on a correct speed_guard that is written differently",
        ),
        Attack(
            "telltale tests",
            "tests that put the text of a version into ids, names, exceptions, warnings, files and output",
            CHAPTER.write(files={limits: TELL_ALL + COMPARE.format(released=function) + TELL_OTHERS}),
            FUNCTION_CHECKS | {"limits_right"},
            says="in test_limits.py fails on a correct speed_guard that is written differently",
        ),
        Attack(
            "lookers-on",
            "tests that count runs in files, and read file times, arguments, environment, paths and processes",
            CHAPTER.write(files={limits: LOOK_AROUND}),
            FUNCTION_CHECKS,
            says="faulty versions pass all tests in test_limits.py, although they break this line of the contract",
        ),
        Attack(
            "argument readers",
            "tests that read how pytest was called",
            CHAPTER.write(files={limits: READ_ARGUMENTS}),
            FUNCTION_CHECKS | {"limits_right"},
            says="on a correct speed_guard that is written differently",
        ),
        Attack(
            "test thief",
            "tests that search the machine, processes and memory for the versions",
            CHAPTER.write(files={limits: SEARCH + LOOK_AROUND}),
            FUNCTION_CHECKS,
        ),
        Attack(
            "report without tests",
            "a setup.py that does not name pytest and writes the report itself",
            CHAPTER.write("pytest_unnamed", heads={"speed_guard/setup.py": FORGE_REPORT}),
            CHAPTER.mutant("pytest_unnamed").fails,
            exactly=True,
            says="`colcon test` ran 0 tests.",
        ),
        Attack(
            "report with a name, without tests",
            "a setup.py that does not name pytest and writes the report with the name that this run gives it",
            CHAPTER.write("pytest_unnamed", heads={"speed_guard/setup.py": FORGE_NAMED_REPORT}),
            CHAPTER.mutant("pytest_unnamed").fails,
            exactly=True,
            says="`colcon test` ran 0 tests.",
        ),
        Attack(
            "long sleep",
            "a test that sleeps, in a file that is too large to search for it",
            CHAPTER.write(swaps={f"{TESTS}/test_guard.py": ("import pytest\n", LONG_SLEEP)}),
            frozenset({"no_sleep"}),
            says="is larger than 256 KiB",
        ),
        Attack(
            "changed package",
            "a given module that is changed, and tests that pass only on the changed one",
            CHAPTER.write(
                swaps={MODULE: ("def safe_speed(", "MARK = 1\n\n\ndef safe_speed(")},
                files={limits: ASK_FOR_MARK},
            ),
            FUNCTION_CHECKS | {"limits_pass", "as_given"},
            says="in test_limits.py",
        ),
    )
