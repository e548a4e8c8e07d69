"""`mutants.yaml` is read completely, or rejected with a reason."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.author.verification.mutants import Edit, Mutant, mutants, write_mutant, write_reference
from autograder.diagnosis import Kind
from autograder.exceptions import GraderError
from autograder.suite import suites
from autograder.suite.suites import Suite

HEAD = "file: my_robot_package/setup.py\nmutants:\n"


@pytest.fixture
def mutants_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The path of a mutants.yaml that belongs to the real suite's checks."""
    real = suites.hidden("02_nodes")
    files = tuple(tmp_path / "hidden" / path.name for path in real.files)
    copied = Suite(real.assignment, real.packages, files, real.checks)
    monkeypatch.setattr(suites, "hidden", lambda assignment: copied)
    return tmp_path / "mutants.yaml"


def test_a_mutant_is_read_with_defaults_for_missing_fields(mutants_file: Path) -> None:
    mutants_file.write_text(
        HEAD + "  - {id: a, title: t, check: nan, edits: [{find: x, replace: y}]}\n"
        "  - {id: b, title: t, check: warns, demo: true, slow: true,"
        " edits: [{file: other.py, find: x, replace: y}]}\n"
    )
    mutants_file.with_name("mutants.snapshot.yaml").write_text("b: {diagnosis: stuck, fails: all}\n")
    first, second = mutants("02_nodes")
    assert (first.check, first.fails) == ("nan", frozenset())
    assert (first.diagnosis, first.demo, first.slow) == (Kind.OK, False, False)
    assert first.edits == (Edit("my_robot_package/setup.py", "x", "y"),)
    assert second.fails == {check.id for check in suites.hidden("02_nodes").checks}
    assert (second.diagnosis, second.demo, second.slow) == (Kind.STUCK, True, True)
    assert second.edits[0].file == "other.py"


def test_a_mutant_for_an_unknown_check_is_refused(mutants_file: Path) -> None:
    mutants_file.write_text(HEAD + "  - {id: a, title: t, check: flies, edits: [{find: x, replace: y}]}\n")
    with pytest.raises(GraderError, match="mutant a: the suite has no check flies"):
        mutants("02_nodes")


def test_a_recorded_diagnosis_that_does_not_exist_is_refused(mutants_file: Path) -> None:
    mutants_file.write_text(HEAD + "  - {id: a, title: t, check: nan, edits: [{find: x, replace: y}]}\n")
    mutants_file.with_name("mutants.snapshot.yaml").write_text("a: {diagnosis: tired, fails: [nan]}\n")
    with pytest.raises(ValueError, match="tired"):
        mutants("02_nodes")


@pytest.mark.parametrize(("find", "times"), [("no such text", 0), ("import", 2)])
def test_an_edit_whose_text_does_not_occur_exactly_once_is_refused(tmp_path: Path, find: str, times: int) -> None:
    shutil.copytree(course_paths.SOLUTIONS / "my_robot_package", tmp_path / "reference")
    text = (tmp_path / "reference" / "setup.py").read_text()
    times = text.count(find)
    assert times != 1
    flawed = Mutant("a", "t", (Edit("my_robot_package/setup.py", find, ""),), "nan")
    with pytest.raises(GraderError, match=f"mutant a: '{find}' occurs {times} times in my_robot_package/setup.py"):
        write_mutant(flawed, ("my_robot_package",), tmp_path / "out")


@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_every_mutant_of_the_course_fits_the_reference_and_changes_it(assignment: str, tmp_path: Path) -> None:
    sources = suites.hidden(assignment).sources
    write_reference(sources, tmp_path / "reference")
    for mutant in mutants(assignment):
        write_mutant(mutant, sources, tmp_path / mutant.id)
        for edit in mutant.edits:
            before, after = (
                path.read_bytes() if (path := tmp_path / name / "src" / edit.file).is_file() else None
                for name in ("reference", mutant.id)
            )
            assert before != after
        assert mutant.check in mutant.fails


def test_mutants_have_unique_names_and_every_check_is_failed_by_one() -> None:
    for assignment in suites.graded_assignments():
        all_mutants = mutants(assignment)
        assert len({mutant.id for mutant in all_mutants}) == len(all_mutants)
        failed = frozenset().union(*(mutant.fails for mutant in all_mutants))
        assert failed == {check.id for check in suites.hidden(assignment).checks}


def test_a_mutant_can_write_and_delete_whole_files(mutants_file: Path, tmp_path: Path) -> None:
    mutants_file.write_text(
        HEAD + "  - {id: a, title: t, check: nan, edits: [{file: my_robot_package/new/notes.txt, write: hello},"
        " {delete: true}]}\n"
    )
    (mutant,) = mutants("02_nodes")
    write_mutant(mutant, ("my_robot_package",), tmp_path / "submission")
    package = tmp_path / "submission" / "src" / "my_robot_package"
    assert (package / "new" / "notes.txt").read_text() == "hello"
    assert not (package / "setup.py").exists()
