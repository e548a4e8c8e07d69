"""A regrading that is killed at any change of a file and then resumed lists all students whose marks changed."""

from __future__ import annotations

import multiprocessing
import shutil
import signal
from collections.abc import Mapping
from pathlib import Path

import pytest

from autograder.report.export import load
from tests.unit.cli.killed_grading import grade

FORKS = multiprocessing.get_context("forkserver")
# Preloaded, because importing them in each process takes longer than a grading here.
FORKS.set_forkserver_preload(
    ["tests.unit.cli.killed_grading", "autograder.cli.grade", "jsonschema.validators", "nbformat", "PIL.PngImagePlugin"]
)
OLD, NEW = "1-0123456789ab", "2-0123456789ab"
FailedChecks = Mapping[str, tuple[str, ...]]
BEFORE: FailedChecks = {"alice": ("nan",), "bob": (), "carol": ("starts",), "dave": ("room",)}
AFTER: FailedChecks = {"alice": (), "bob": (), "carol": ("node_name",), "dave": ("room",)}
INSTANTS = 20
EVERY_RUN = range(0, INSTANTS, 3)  # the others are nightly
LIST = """
Marks that changed because of the suite or the submission:
alice (02_nodes): 51 -> 53
    nan: 0 -> 2
carol (02_nodes): 52 -> 52
    starts: 0 -> 1
    node_name: 1 -> 0
erin (02_nodes): 51 -> 53
    nan: 0 -> 2
"""


def run(folder: Path, failed_checks: FailedChecks, version: str, *options: str, kill_at: int = -1) -> int | None:
    """Grade the class in a separate process; return its exit status."""
    process = FORKS.Process(target=grade, args=(folder, failed_checks, version, *options), kwargs={"kill_at": kill_at})
    process.start()
    process.join()
    return process.exitcode


@pytest.fixture(scope="module")
def graded_class(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A class that was graded with the old version. Erin's submission is a copy of Alice's."""
    folder = tmp_path_factory.mktemp("graded")
    for student in (*BEFORE, "erin"):
        package = folder / "class" / student / "src" / "package"
        package.mkdir(parents=True)
        (package / "package.xml").write_text("alice" if student == "erin" else student)
    assert run(folder, BEFORE, OLD) == 0
    return folder


@pytest.fixture(scope="module")
def changes(graded_class: Path, tmp_path_factory: pytest.TempPathFactory) -> int:
    """The number of changes to files by a grading of the class with the new version."""
    folder = copy(graded_class, tmp_path_factory.mktemp("counted"))
    assert run(folder, AFTER, NEW, "--resume") == 0
    assert listed(folder) == [LIST]
    return int((folder / "changes").read_text())


def copy(graded_class: Path, folder: Path) -> Path:
    shutil.copytree(graded_class, folder, dirs_exist_ok=True)
    (folder / "printed").unlink()
    return folder


def listed(folder: Path) -> list[str]:
    """Return the lists of changes that were printed."""
    heading = LIST.splitlines(keepends=True)[1]
    texts = (folder / "printed").read_text().split(heading)[1:]  # the next grading begins with a line in brackets
    return [f"\n{heading}{text.partition('[')[0]}" for text in texts]


@pytest.mark.promise(
    "Neither Ctrl-C nor a crashed machine loses results",
    "the same command lists all changes when it completes",
    "Each old result stays until the new one is complete.",
)
@pytest.mark.slow
@pytest.mark.parametrize(
    "instant", [i if i in EVERY_RUN else pytest.param(i, marks=pytest.mark.nightly) for i in range(INSTANTS)]
)
def test_the_list_of_changes_is_whole_after_a_kill_at_any_instant(
    graded_class: Path, changes: int, instant: int, tmp_path: Path
) -> None:
    folder, kill_at = copy(graded_class, tmp_path), instant * changes // INSTANTS
    options = ("--resume",) if instant % 4 else ()
    assert run(folder, AFTER, NEW, *options, kill_at=kill_at) == -signal.SIGKILL
    marks = {result.student: result.score for result in load(folder / "results")}
    assert marks.keys() == {*BEFORE, "erin"}
    run(folder, AFTER, NEW, "--resume", kill_at=kill_at // 2)
    assert run(folder, AFTER, NEW, "--resume") == 0
    assert set(listed(folder)) == {LIST}
    assert {result.suite_version for result in load(folder / "results")} == {NEW}
    file_names = {path.name for path in (folder / "results").rglob("*")}
    assert file_names.isdisjoint({".unfinished", "earlier-marks.json"})


def test_changes_that_were_listed_are_not_listed_again(graded_class: Path, changes: int, tmp_path: Path) -> None:
    folder = copy(graded_class, tmp_path)
    assert [run(folder, AFTER, NEW, "--resume") for _ in range(2)] == [0, 0]
    assert (folder / "printed").read_text().count("[5/5]") == 2
    assert "Marks that changed" not in (folder / "printed").read_text().rpartition("[5/5]")[2]
