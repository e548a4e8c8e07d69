"""`autograder course check` reports all mistakes of an author at once, each with its file and line."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from autograder import course_paths
from tests.unit.course.check_server import END

CHECKS = "checks/ch10_mapping"
SNAPSHOT = f"{CHECKS}/mutants.snapshot.yaml"
SUITE = f"{CHECKS}/hidden/__init__.py"
READINGS = f"{CHECKS}/hidden/readings.py"
MUTANTS = f"{CHECKS}/mutants.yaml"
NOTEBOOK = "chapters/10_mapping/10_mapping.ipynb"
CheckCourse = Callable[[], str]
EXTRA_MODULE = '''"""More."""

from autograder.checking import expect, group

check = group("readings")


@check(points=1, covers="counts")
def test_more():
    """It does more."""
    expect(True, "no")
'''

# The file, the text to replace, its replacement, the line of the finding (with its cell, in a notebook), and the start
# of its message. A file without a text to replace is created.
SLIPS = [
    (MUTANTS, "    check: nearest\n\n  - id: first", "\n  - id: first", "5", "`mutants[0]` (farthest) has no `check`"),
    (MUTANTS, "find: min(filter, ", "", "7", "`mutants[0].edits[0]` (farthest) has `replace`, but no `find`"),
    (
        MUTANTS,
        "find: min(filter",
        "find: min(filer",
        "7",
        "'min(filer' occurs nowhere in mapping/mapping/nearest.py, and",
    ),
    (
        MUTANTS,
        "title: takes the l",
        "title: takes: the l",
        "6",
        "cannot be read as YAML: mapping values are not allowed",
    ),
    (
        MUTANTS,
        "title: takes the l",
        "titel: takes the l",
        "6",
        "`mutants[0]` (farthest) has an unknown key `titel`: did",
    ),
    (
        MUTANTS,
        "mapping/nearest.py",
        "mapping/nearset.py",
        "3",
        "the reference has no file solutions/mapping/mapping/near",
    ),
    (MUTANTS, "id: first", "id: farthest", "10", "two mutants are called `farthest`"),
    (MUTANTS, "check: counts", "check: count", "25", "the hidden suite has no check `count`: did you mean `counts`?"),
    (MUTANTS, "mutants:\n", "mutants: []\nold:\n", "1", "no mutant fails the check `nearest`: add one with an error"),
    (f"{CHECKS}/survivors.yaml", None, "- because: it is\n  mutants: [a]\n", "1", "`[0]` has an unknown key `because`"),
    (
        SUITE,
        '("readings",)',
        '("readings")',
        "4",
        "`MODULES` is a string, not a tuple: write MODULES = ('readings',)",
    ),
    (SUITE, '("readings",)', '("reading",)', "4", "`MODULES` names 'reading', but reading.py does not exist beside it"),
    (
        SUITE,
        "MODULES",
        "BUILD_MAY = True\nMODULES",
        "4",
        "`BUILD_MAY` is not a setting of a suite: did you mean `BUILD_",
    ),
    (SUITE, '("mapping",)', '("maping",)', "3", "names 'maping', but the reference has no folder solutions/maping"),
    (f"{CHECKS}/hidden/more.py", None, EXTRA_MODULE, "9", "the checks in this file do not count: `MODULES` in hid"),
    (
        READINGS,
        'after=("nearest",)',
        'after=("nearest")',
        "23",
        "`after` of the check `counts` is a string, not a tuple",
    ),
    (
        READINGS,
        'after=("nearest",)',
        'after=("near",)',
        "23",
        "the check `counts` names `near` in `after`, but no check",
    ),
    (
        READINGS,
        'covers="silent"',
        'covers="silence"',
        "38",
        "the hidden check 'silent' covers 'silence', which no cell names: did you mean `silent`?",
    ),
    (
        READINGS,
        "silent(robot:",
        "silent(robt:",
        "38",
        "`test_silent` uses the unknown fixture `robt`: did you mean `robot`?",
    ),
    (
        READINGS,
        "from autograder.checking import expect, group, hint",
        "from autograder.suite import expect, group, hint",
        "6",
        "imports `autograder.suite`, which may change without notice: import from `autograder.checking`",
    ),
    (READINGS, "check(points=1", "check(point=1", "36", "`point` is not an argument of @check: did you mean `points`?"),
    (
        READINGS,
        '    """It publishes nothing',
        "    # It publishes nothing",
        "38",
        "the check `silent` has no docstring, the",
    ),
    (READINGS, "shuffle(readings)", "shuffle(readings", "30", "is not Python: '(' was never closed"),
    (READINGS, "import math", "import maths", "3", "cannot be imported: ModuleNotFoundError: No module named 'maths'"),
    (
        f"{CHECKS}/visible/hidden_titles.json",
        "of each scan",
        "of a scan",
        "1",
        "is out of date: run `autograder course tables`",
    ),
    ("course.yaml", "title:", "titel:", "3", "the file has an unknown key `titel`: did you mean `title`?"),
    ("syllabus.yaml", "objectives:", "objectives:\n  drive: Drive", "3", "no hidden check covers 'drive': Drive"),
    (
        "solutions/mapping/package.xml",
        "<name>mapping",
        "<name>maping",
        "4",
        "names the package 'maping', but its folder",
    ),
    (
        NOTEBOOK,
        '"hide": [',
        '"hid": [',
        "127, cell 'nearest'",
        "the metadata are invalid: `course` has an unknown key `hid`",
    ),
    (NOTEBOOK, '"nbformat": 4,', '"nbformat": 4', "331", "is not JSON: Expecting ',' delimiter"),
    (NOTEBOOK, '"exercise": "exercise"', '"exercise": "exercises"', "313", "the notebook has no cell 'exercises'"),
    ("worlds/hall.yaml", None, "name: hall\nboxs: []\n", "2", "the world has no field 'boxs'. Did you mean 'boxes'?"),
    (
        MUTANTS,
        "find: min(filter",
        "find: nearest(scan)",
        "7",
        "'nearest(scan)' occurs 2 times in mapping/mapping/nearest.py, and",
    ),
    (
        NOTEBOOK,
        '"target": "ws/src/mapping/mapping/nearest.py"',
        '"target": "ws/src/mapping/mapping/nearst.py"',
        "140, cell 'nearest'",
        "the target `ws/src/mapping/mapping/nearst.py` does not match its source mapping/mapping/nearest.py: did",
    ),
    (
        SNAPSHOT,
        "first: [",
        "frist: [",
        "4",
        "mutants.yaml has no mutant `frist`: correct its `id` there, or remove this",
    ),
    (
        MUTANTS,
        "replace: max(filter",
        'replace: "max((filter"',
        "7",
        "after this edit, mapping/mapping/nearest.py is not Python: ",
    ),
    (
        f"{CHECKS}/variants/loop/mapping/mapping/nearst.py",
        None,
        '"""Nothing."""',
        "1",
        "replaces no file of the reference, and no other file of the variant names `nearst`: did you mean `mapping",
    ),
    (
        READINGS,
        "check(points=1",
        'check(points="1"',
        "36",
        "`points` of the check `silent` is '1': write a number, such as points=1, without quotes",
    ),
]


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A new course with a new chapter."""
    folder = tmp_path_factory.mktemp("slips") / "mine"
    script = f"""if True:
        import os
        from pathlib import Path
        from autograder.author.course.new import write_chapter, write_course
        write_course(Path({str(folder)!r}))
        os.environ["AUTOGRADER_COURSE"] = {str(folder)!r}
        write_chapter("10_mapping")
    """
    subprocess.run([sys.executable, "-c", script], check=True, cwd=course_paths.ROOT)
    return folder


@pytest.fixture(scope="module")
def check(course: Path) -> Iterator[CheckCourse]:
    """Run `autograder course check` on the course, and return its output, with its exit status in the last line."""
    command = [sys.executable, "-m", "tests.unit.course.check_server"]
    environment = {**os.environ, "AUTOGRADER_COURSE": str(course)}
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, cwd=course_paths.ROOT, env=environment, stdin=pipe, stdout=pipe, text=True
    ) as server:
        assert server.stdin is not None
        assert server.stdout is not None
        requests, replies = server.stdin, server.stdout

        def run() -> str:
            requests.write("\n")
            requests.flush()
            output = ""
            while not output.rpartition("\n")[2].startswith(END):
                line = replies.readline()
                assert line, output
                output += f"\n{line.rstrip()}"
            return output

        yield run
        requests.close()


def slip(course: Path, file: str, text: str | None, replacement: str) -> Callable[[], None]:
    """Make a slip in a file of the course, and return a function that undoes it."""
    path = course / file
    if text is None:
        path.parent.mkdir(exist_ok=True)
        path.write_text(replacement)
        return path.unlink
    original = path.read_text()
    assert text in original
    path.write_text(original.replace(text, replacement, 1))

    def revert() -> None:
        path.write_text(original)

    return revert


@pytest.mark.promise(
    "names the file and line of every mistake", "`course check` finds a text that does not occur in the reference"
)
@pytest.mark.parametrize(
    ("file", "text", "replacement", "line", "message"), SLIPS, ids=[each[4][:40] for each in SLIPS]
)
def test_a_slip_is_reported_with_its_file_and_line(
    course: Path, check: CheckCourse, file: str, text: str | None, replacement: str, line: str, message: str
) -> None:
    revert = slip(course, file, text, replacement)
    try:
        output = check()
    finally:
        revert()
    reported_file = course / file if file == "course.yaml" else file
    assert f"\n{reported_file}:{line}: {message}" in output
    assert output.endswith(f"\n{END} 1")
    assert "Traceback" not in output


def test_slips_in_several_files_are_all_reported_at_once(course: Path, check: CheckCourse) -> None:
    chosen = [SLIPS[index] for index in (0, 10, 17, 27, 28, 31)]
    reverts = [slip(course, *case[:3]) for case in chosen]
    try:
        output = check()
    finally:
        for revert in reverts:
            revert()
    unreported = [sentence for *_, sentence in chosen if sentence not in output]
    assert unreported == [
        SLIPS[17][4]
    ]  # the requirements that a check covers are known only if its suite can be imported
    assert check() == f"\n{END} 0"


def test_a_page_about_the_chapters_that_is_out_of_date_is_reported(course: Path, check: CheckCourse) -> None:
    revert = slip(course, "chapters/README.md", None, "# The course\n")
    try:
        output = check()
    finally:
        revert()
    assert output == f"\nchapters/README.md:1: is out of date: run `autograder course tables`\n{END} 1"


def test_sync_reports_what_is_wrong_with_a_suite_that_cannot_be_imported(course: Path) -> None:
    undo = slip(course, SUITE, '("readings",)', '("readings")')
    command = [sys.executable, "-m", "autograder", "--course", str(course), "course", "sync"]
    try:
        completed = subprocess.run(command, cwd=course_paths.ROOT, text=True, capture_output=True)
    finally:
        undo()
    assert completed.returncode == 1
    assert completed.stderr.startswith(f"autograder: {SUITE}:4: `MODULES` is a string, not a tuple")
    assert "Traceback" not in completed.stderr
