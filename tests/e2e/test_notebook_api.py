"""`drive` and `check`, as students call them in a notebook."""

from __future__ import annotations

import os
import re
import shutil
from dataclasses import replace
from functools import partial
from pathlib import Path

import nbformat
import numpy as np
import pytest
from nbformat.v4 import new_code_cell
from nbgrader.validator import Validator

from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import chapters
from autograder.author.verification.mutants import mutants, write_mutant, write_reference
from autograder.building import bundle_server
from autograder.building.interfaces import Cache
from autograder.course_paths import SOLUTIONS
from autograder.notebook import check, drive, ros, stored_results
from autograder.notebook.checking import CheckReport
from autograder.notebook.driving import FAULTS, DriveReport
from autograder.notebook.notices import Notice
from autograder.notebook.terminal import shell
from autograder.run.sandbox import best_isolation
from autograder.run.sandbox.limits import SOURCES
from autograder.run.sandbox.trees import Entry, read_tree
from autograder.suite import Outcome
from sim import Pose, RobotSpec, Simulation, World
from sim.codec import to_json

PACKAGE = "my_robot_package"
MAX_ARGUMENT = 128 * 1024  # bytes of a program's argument on Linux: MAX_ARG_STRLEN, see execve(2)


@pytest.fixture(scope="session")
def reference_workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("reference")
    write_reference((PACKAGE,), folder)
    return folder


@pytest.fixture(autouse=True)
def _own_result_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stored_results, "CACHE", str(tmp_path / "cache"))


def _mutant(name: str, folder: Path) -> Path:
    write_mutant(next(mutant for mutant in mutants("02_nodes") if mutant.id == name), (PACKAGE,), folder)
    return folder


@pytest.mark.promise("If nothing has changed since the last check, it shows that result again and says so.")
def test_the_reference_passes_every_visible_check_and_leaves_nothing_in_the_workspace(
    reference_workspace: Path,
) -> None:
    report = check("02_nodes", reference_workspace)
    assert isinstance(report, CheckReport)
    assert report.passed, repr(report)
    assert [path.name for path in reference_workspace.iterdir()] == ["src"]
    second_report = check("02_nodes", reference_workspace)
    assert isinstance(second_report, CheckReport)
    assert replace(second_report, since="") == report
    assert re.search(
        r"16 of 16 visible checks passed. Unchanged since \d\d:\d\d, so nothing was run.", repr(second_report)
    )


def test_check_reuses_message_packages_that_were_built_before(tmp_path: Path) -> None:
    write_reference(("my_robot_interfaces", PACKAGE), tmp_path)
    source = tmp_path / "src/my_robot_interfaces"
    tree = {Entry(source.name, "folder"): b""}
    tree |= {
        replace(entry, path=f"{source.name}/{entry.path}"): data for entry, data in read_tree(source, SOURCES).items()
    }
    make = partial(bundle_server._make, tree, best_isolation())
    with Cache.default(bundle_server.CACHE).use(bundle_server.key(tree), make) as cached:
        os.utime(cached, (0, 0))  # using the entry updates its time
        report = check("03_interfaces", tmp_path)
        assert isinstance(report, CheckReport)
        assert report.passed, repr(report)
        assert cached.stat().st_mtime > 0


@pytest.mark.promise(
    "`check(...)` answers at once.",
    "For each check it says whether it passed and, if it failed, why, with a hint.",
    "Each exercise has a check that answers at once",
)
def test_a_failed_check_shows_hints_and_the_other_checks_still_run(tmp_path: Path) -> None:
    report = check("02_nodes", _mutant("drives_blind", tmp_path))
    assert isinstance(report, CheckReport)
    (failed,) = [line for line in report.lines if line.outcome.value == "failed"]
    assert "A second after the last scan, the robot drove forward" in failed.message
    assert failed.hints


@pytest.mark.promise("`check('03_interfaces', exercise=1)` checks exercise 1 alone")
def test_an_exercise_is_checked_with_the_failed_check_that_it_depends_on(tmp_path: Path) -> None:
    write_reference((PACKAGE,), tmp_path)
    path = tmp_path / "src" / PACKAGE / PACKAGE / "configuration.py"
    path.write_text(path.read_text().replace("node.declare_parameter(", "node.declare_parameters(", 1))
    report = check("05_parameters", tmp_path, exercise=2)
    assert isinstance(report, CheckReport)
    failed, *other_lines = report.lines
    # "starts" is a check of exercise 1, without which the others cannot run.
    assert (failed.id, failed.outcome) == ("starts", Outcome.FAILED)
    assert {line.outcome for line in other_lines} == {Outcome.NOT_CHECKED}
    assert [line.id for line in other_lines] == ["contradiction", "together", "rate", "refused_whole", "lets_pass"]
    assert report.summary == "05_parameters, exercise 2: 0 of 6 visible checks passed."


def test_a_syntax_error_is_reported_in_a_sentence_without_a_traceback(tmp_path: Path) -> None:
    _mutant("syntax_error", tmp_path)
    report = check("02_nodes", tmp_path)
    assert isinstance(report, CheckReport)
    assert report.trouble is not None
    assert "Python cannot read your file: expected ':'" in report.trouble.sentence
    notice = drive(PACKAGE, "robot_controller", seconds=1, workspace=tmp_path)
    assert isinstance(notice, Notice)
    assert notice.sentence == report.trouble.sentence


def test_a_drive_is_the_same_every_time_and_shows_its_track(reference_workspace: Path) -> None:
    runs = [drive(PACKAGE, "robot_controller", seconds=12, seed=3, workspace=reference_workspace) for _ in range(2)]
    first, second = (run for run in runs if isinstance(run, DriveReport))
    assert first.recording.sha256() == second.recording.sha256()
    assert first.commands == second.commands
    assert first.collided_at is None
    assert "Robot controller initialised" in first.output
    assert "image/png" in str(first._repr_mimebundle_()) or "image/svg" in str(first._repr_mimebundle_())


def test_drive_runs_in_a_map_of_ros(reference_workspace: Path) -> None:
    report = drive(PACKAGE, "robot_controller", world="office", seconds=2, workspace=reference_workspace)
    assert isinstance(report, DriveReport), repr(report)
    assert "office" in repr(report)


def test_drive_runs_in_a_world_of_thousands_of_walls(reference_workspace: Path) -> None:
    angles = np.linspace(-np.pi, np.pi, 5001)
    segment_ends = 3.0 * np.column_stack([np.cos(angles), np.sin(angles)])
    world = World.from_segments(
        np.hstack([segment_ends[:-1], segment_ends[1:]]), name="round", starts=(Pose(0.0, 0.0, 0.0),)
    )
    assert len(to_json(Simulation(world, (RobotSpec(),)))) > MAX_ARGUMENT
    report = drive(PACKAGE, "robot_controller", world=world, seconds=2, workspace=reference_workspace)
    assert isinstance(report, DriveReport), repr(report)


def test_a_failed_lidar_stops_the_reference_and_not_the_mutant(reference_workspace: Path, tmp_path: Path) -> None:
    reference_run = drive(PACKAGE, "robot_controller", seconds=14, faults="dead", workspace=reference_workspace)
    mutant_run = drive(
        PACKAGE, "robot_controller", seconds=14, faults=FAULTS["dead"], workspace=_mutant("drives_blind", tmp_path)
    )
    assert isinstance(reference_run, DriveReport)
    assert isinstance(mutant_run, DriveReport)
    assert {(v, w) for t, v, w in reference_run.commands if t > 11} == {(0.0, 0.0)}
    assert (0.0, 0.0) not in {(v, w) for t, v, w in mutant_run.commands if t > 11}


def test_a_missing_package_is_reported_in_a_sentence_without_a_traceback(reference_workspace: Path) -> None:
    notice = drive("no_such_package", "robot_controller", seconds=1, workspace=reference_workspace)
    assert isinstance(notice, Notice)
    assert "The package no_such_package is missing: src contains my_robot_package" in notice.sentence


def test_colcon_shows_no_stderr_for_a_successful_build(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")  # as on some machines
    ros()
    shutil.copytree(SOLUTIONS / "square_dance", tmp_path / "src/square_dance")
    shell(f"cd {tmp_path} && colcon --log-level error build", workspace=tmp_path)
    output = capsys.readouterr().out
    assert "1 package finished" in output
    assert "stderr" not in output


def test_the_traceback_of_a_crash_shows_only_the_students_files(tmp_path: Path) -> None:
    _mutant("drives_blind", tmp_path)
    path = next(tmp_path.rglob("robot_controller.py"))
    text = path.read_text()
    path.write_text(text.replace("rclpy.spin(node)", "node.no_such_method()"))
    line = text[: text.index("rclpy.spin(node)")].count("\n") + 1
    notice = drive(PACKAGE, "robot_controller", seconds=1, workspace=tmp_path)
    assert isinstance(notice, Notice)
    frame = f'  File "ws/src/{path.relative_to(tmp_path / "src")}", line {line}, in main'
    assert notice.detail.splitlines()[1] == frame
    assert "autograder" not in notice.detail


def test_nbgraders_validate_fails_on_an_unsolved_notebook(tmp_path: Path) -> None:
    chapter = next(chapter for chapter in chapters() if chapter.assignment == "02_nodes")
    released = in_form(chapter.read(), Form.RELEASED)
    graded = [cell for cell in released.cells if cell.metadata.get("nbgrader", {}).get("grade")]
    released.cells = [new_code_cell("from autograder.notebook import grade"), *graded]
    nbformat.write(released, tmp_path / chapter.notebook_path.name)
    validation = Validator(ignore_checksums=True).validate(str(tmp_path / chapter.notebook_path.name))
    assert graded
    assert [cell["source"] for cell in validation["failed"]] == [cell.source for cell in graded]
