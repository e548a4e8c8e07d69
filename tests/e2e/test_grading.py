"""Real gradings: a correct submission gets full marks, errors are named, and a grader failure is not a zero."""

from __future__ import annotations

import itertools
import json
import shutil
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import nbformat
import pytest
from click.testing import CliRunner
from nbformat.v4 import new_code_cell, new_notebook

from autograder import cli
from autograder.author.verification.mutants import write_reference
from autograder.diagnosis import Kind
from autograder.exceptions import IsolationError, UsageError
from autograder.grade import grade_submission, own_sandbox
from autograder.grade.batch import grade_all
from autograder.grade.job import Job
from autograder.result.model import Result, Status, write_json
from autograder.run.sandbox import Isolation, isolation
from autograder.suite import Outcome, suites
from tests.e2e.results import without_times

ASSIGNMENT = "02_nodes"
PACKAGE = "my_robot_package"
DRIVES = {check.id for check in suites.hidden(ASSIGNMENT).checks if check.group == "worlds"}
CONTROLLER = f"{PACKAGE}/{PACKAGE}/nodes/robot_controller.py"
SEED = 11


@pytest.fixture(scope="session")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The reference solution as a source tree."""
    folder = tmp_path_factory.mktemp("reference") / "tree"
    write_reference((PACKAGE,), folder)
    return folder


@pytest.fixture(scope="session")
def layouts(reference: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The reference in two layouts: a zip of an assignment's folder, and a lone notebook."""
    folder = tmp_path_factory.mktemp("layouts")
    with zipfile.ZipFile(folder / "zip.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for path in (path for path in reference.rglob("*") if path.is_file()):
            archive.write(path, f"{ASSIGNMENT}/ws/{path.relative_to(reference)}")
    answer = (reference / "src" / CONTROLLER).read_text()
    cell = new_code_cell(f"%%writefile ws/src/{CONTROLLER}\n{answer}")
    cell.metadata.nbgrader = {"grade_id": "robot-controller", "grade": False, "solution": True, "locked": False}
    nbformat.write(new_notebook(cells=[cell]), folder / "notebook.ipynb")
    return {"zip": folder / "zip.zip", "notebook": folder / "notebook.ipynb"}


@pytest.fixture(scope="session")
def parallel_results(layouts: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> dict[str, Result]:
    """The results of both layouts, graded in parallel."""
    results = grade_all(layouts, ASSIGNMENT, seed=SEED, out=tmp_path_factory.mktemp("parallel"), jobs=2)
    return {result.student: result for result in results}


def _grade(path: Path, out: Path) -> Result:
    return grade_submission(Job(path, ASSIGNMENT, "alice", SEED, out))


@pytest.mark.promise(
    "A submission is the student's folder, a zip or tar archive of it, the notebook alone, or a source tree."
)
@pytest.mark.parametrize("layout", ["zip", "notebook"])
def test_the_reference_gets_full_marks_in_every_layout(parallel_results: dict[str, Result], layout: str) -> None:
    result = parallel_results[layout]
    assert [check.id for check in result.checks if check.outcome is not Outcome.PASSED] == []
    assert (result.status, result.diagnosis.kind, result.score) == (Status.GRADED, Kind.OK, result.max_score)
    assert result.max_score == suites.hidden(ASSIGNMENT).max_score
    assert (result.seed, result.isolation, result.suite_version) == (
        SEED,
        "bubblewrap",
        suites.hidden(ASSIGNMENT).version,
    )
    assert result.build is not None
    assert result.build.packages[-1] == PACKAGE


@pytest.mark.promise("Each student has a folder in `results` with `result.json`, pictures, and")
def test_the_pictures_of_the_tracks_are_stored_beside_the_result(parallel_results: dict[str, Result]) -> None:
    assert {artifact.check for artifact in parallel_results["zip"].artifacts} == DRIVES


@pytest.mark.promise("A minute of driving takes seconds, and a mark is the same every time.")
def test_serial_and_parallel_grading_give_the_same_result(
    parallel_results: dict[str, Result], layouts: dict[str, Path], tmp_path: Path
) -> None:
    (serial,) = grade_all({"zip": layouts["zip"]}, ASSIGNMENT, seed=SEED, out=tmp_path, jobs=1)
    assert without_times(serial.to_json()) == without_times(parallel_results["zip"].to_json())
    tracks = [artifact.sha256 for artifact in serial.artifacts]
    assert tracks == [artifact.sha256 for artifact in parallel_results["notebook"].artifacts]
    assert len(set(tracks)) == len(DRIVES)


@pytest.mark.promise(
    "autograder replay results/alice --check room",
    "Each mark is stored with its seed, and the same seed gives the same inputs.",
)
def test_a_check_is_replayed_with_the_seed_of_its_result(
    parallel_results: dict[str, Result], layouts: dict[str, Path], tmp_path: Path
) -> None:
    write_json(tmp_path / "result.json", parallel_results["zip"].to_json())
    submission = str(layouts["zip"])
    arguments = ["replay", str(tmp_path), "--check", "room", "--submission", submission, "--mcap", "--no-open"]
    process = CliRunner().invoke(cli.group, arguments)
    assert process.exit_code == 0, process.output
    assert "differs from the graded submission" not in process.output
    folder = tmp_path / "replay" / "room"
    assert (folder / "room-track" / "room-track.mcap").is_file()
    picture = next(artifact for artifact in parallel_results["zip"].artifacts if artifact.check == "room")
    assert picture.caption in (folder / "feedback.html").read_text(encoding="utf-8")  # the distances are the same


# Diagnoses of invalid submissions.


def _remove(name: str) -> Callable[[Path], None]:
    return lambda source: (source / PACKAGE / name).unlink()


def _replace(name: str, text: str) -> Callable[[Path], None]:
    def replace(source: Path) -> None:
        (source / PACKAGE / name).write_text(text)

    return replace


def _rename_script(source: Path) -> None:
    setup = source / PACKAGE / "setup.py"
    setup.write_text(setup.read_text().replace("robot_controller =", "robot_control ="))


@pytest.mark.parametrize(
    ("damage", "kind", "words"),
    [
        pytest.param(_remove("setup.py"), Kind.HALF_WRITTEN_PACKAGE, "has no setup.py", id="no setup.py"),
        pytest.param(
            _replace("setup.py", "setup(\n"), Kind.BUILD_FAILED, "The first error: setup.py, line ", id="setup.py"
        ),
        pytest.param(_rename_script, Kind.MISSING_EXECUTABLE, "it installs", id="no such script"),
    ],
)
def test_a_package_that_cannot_be_checked_gets_a_diagnosis_with_the_remedy(
    damage: Callable[[Path], None], kind: Kind, words: str, reference: Path, tmp_path: Path
) -> None:
    shutil.copytree(reference, tmp_path / "alice")
    damage(tmp_path / "alice" / "src")
    result = _grade(tmp_path / "alice", tmp_path / "out")
    assert (result.status, result.score, result.diagnosis.kind) == (Status.GRADED, 0.0, kind)
    assert words in result.diagnosis.sentence
    assert all(check.outcome is not Outcome.PASSED for check in result.checks)


def _write_nothing(folder: Path) -> None:
    (folder / "src").mkdir()


def _write_link(folder: Path) -> None:
    (folder / "src").mkdir()
    (folder / "src" / "link").symlink_to("/etc")


@pytest.mark.parametrize(
    ("write", "kind", "words"),
    [
        pytest.param(_write_nothing, Kind.NOTHING_SUBMITTED, "Hand in the assignment's whole folder", id="nothing"),
        pytest.param(_write_link, Kind.UNSAFE_ARCHIVE, "is a symbolic link", id="link"),
        pytest.param(
            lambda folder: (folder / f"{ASSIGNMENT}.ipynb").write_text('{"cells": ['),
            Kind.UNREADABLE,
            "save it and hand it in again",
            id="cut notebook",
        ),
    ],
)
def test_a_submission_that_cannot_be_read_is_unclear_instead_of_zero(
    write: Callable[[Path], object], kind: Kind, words: str, tmp_path: Path
) -> None:
    (tmp_path / "alice").mkdir()
    write(tmp_path / "alice")
    result = _grade(tmp_path / "alice", tmp_path / "out")
    assert (result.status, result.diagnosis.kind) == (Status.UNCLEAR, kind)
    assert words in result.diagnosis.sentence


def test_a_submitted_file_that_stops_the_kernel_from_starting_is_named(tmp_path: Path) -> None:
    (tmp_path / "alice").mkdir()
    nbformat.write(new_notebook(cells=[new_code_cell("1")]), tmp_path / "alice" / f"{ASSIGNMENT}.ipynb")
    (tmp_path / "alice" / "ipykernel_launcher.py").write_text("raise SystemExit(0)")
    result = _grade(tmp_path / "alice", tmp_path / "out")
    assert (result.status, result.diagnosis.kind) == (Status.GRADED, Kind.NOTEBOOK_FAILED)
    assert "a file beside the notebook" in result.diagnosis.sentence


def test_files_that_a_notebook_wrote_before_its_kernel_died_are_graded(tmp_path: Path) -> None:
    cells = [
        "%%writefile ws/src/my_robot_package/setup.py\nsyntax error",
        "import os\nos._exit(0)",
        "%%writefile never\n",
    ]
    (tmp_path / "alice").mkdir()
    notebook = new_notebook(cells=[new_code_cell(cell) for cell in cells])
    nbformat.write(notebook, tmp_path / "alice" / f"{ASSIGNMENT}.ipynb")
    result = _grade(tmp_path / "alice", tmp_path / "out")
    assert (result.status, result.diagnosis.kind) == (Status.GRADED, Kind.BUILD_FAILED)


# Failures of the grader.


@pytest.fixture
def worker(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Return a function that replaces the worker by other programs, one for each start, with the same arguments."""

    def replace(*codes: str) -> None:
        programs = itertools.cycle(codes)
        monkeypatch.setattr(
            own_sandbox,
            "_worker_command",
            lambda job, line: [sys.executable, "-c", next(programs), job.to_json(), str(line)],
        )

    return replace


RUN = "\nfrom autograder.grade.worker import main\nmain()"
BROKEN_SUITE = """
import autograder.grade.plugin as plugin
def run(files, plugin):
    plugin.failures.append("def test_secret(): CANARY")
    return 3
plugin.run = run
"""
BROKEN_HARNESS = """
from autograder.ros import activate
activate()
from autograder.exceptions import GraderError
from autograder.harness import SteppedHarness
def step(harness, dt_ns):
    raise GraderError("messages were lost: CANARY")
SteppedHarness.step = step
"""


@pytest.mark.promise(
    'If the grader itself fails, the result says "not graded", never zero.', '| The result says "not graded". |'
)
@pytest.mark.parametrize(
    ("code", "logged"),
    [
        pytest.param("raise SystemExit('the disk is full: CANARY')", "the disk is full", id="ends"),
        pytest.param("import os\nos.kill(os.getpid(), 9)", "The worker ended", id="killed"),
        pytest.param("pass", "The worker ended: exited, 0.", id="no result"),
        pytest.param(BROKEN_SUITE + RUN, "def test_secret", id="broken suite"),
        pytest.param(BROKEN_HARNESS + RUN, "messages were lost", id="broken harness"),
    ],
)
def test_a_failure_of_the_grader_is_reported_as_not_graded_and_never_as_zero(
    code: str, logged: str, worker: Callable[..., None], reference: Path, tmp_path: Path
) -> None:
    worker(code)
    result = _grade(reference, tmp_path / "out")
    assert (result.status, result.diagnosis.kind) == (Status.NOT_GRADED, Kind.NOT_GRADED)
    assert "This is not a zero" in result.diagnosis.sentence
    assert {check.outcome for check in result.checks} == {Outcome.NOT_CHECKED}
    assert result.max_score == suites.hidden(ASSIGNMENT).max_score
    assert "CANARY" not in (tmp_path / "out" / "result.json").read_text()
    assert logged in (tmp_path / "out" / "grader.log").read_text()


def test_a_failure_of_the_grader_that_happens_once_is_retried(
    worker: Callable[..., None], reference: Path, tmp_path: Path
) -> None:
    worker("1 / 0", RUN)
    shutil.rmtree(shutil.copytree(reference, tmp_path / "alice") / "src" / PACKAGE)
    (tmp_path / "alice" / "src" / "note").write_text("")
    result = _grade(tmp_path / "alice", tmp_path / "out")
    assert (result.status, result.diagnosis.kind) == (Status.GRADED, Kind.MISSING_PACKAGE)


def test_a_result_of_an_earlier_run_is_never_used_for_this_run(
    worker: Callable[..., None], reference: Path, tmp_path: Path, parallel_results: dict[str, Result]
) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "result.json").write_text(json.dumps(parallel_results["zip"].to_json()))
    worker("pass")
    assert _grade(reference, tmp_path / "out").status is Status.NOT_GRADED


def test_a_missing_submission_or_assignment_is_a_usage_error(reference: Path, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="there is no such file or folder"):
        _grade(tmp_path / "nobody", tmp_path / "out")
    with pytest.raises(UsageError, match="there are no hidden checks for '77_none'"):
        grade_submission(Job(reference, "77_none", "a", 1, tmp_path / "out"))


def test_a_machine_without_namespaces_refuses_to_grade_at_the_weak_isolation_level(
    reference: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(isolation, "namespaces_failure", lambda: "no user namespaces")
    with pytest.raises(IsolationError, match="cannot isolate submissions: no user namespaces"):
        _grade(reference, tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.promise("`--isolation process` still grades there")
def test_the_weaker_isolation_level_is_named_in_the_result(reference: Path, tmp_path: Path) -> None:
    shutil.copytree(reference, tmp_path / "alice")
    (tmp_path / "alice" / "src" / PACKAGE / "setup.py").unlink()
    result = grade_submission(Job(tmp_path / "alice", ASSIGNMENT, "a", 1, tmp_path / "out", Isolation.PROCESS))
    assert result.isolation == "process"
    assert result.diagnosis.kind is Kind.HALF_WRITTEN_PACKAGE
