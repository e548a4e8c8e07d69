"""A run of tests is recalled where nothing that it could read has changed, and made anew everywhere else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from autograder.probes.memory import Memory
from autograder.probes.test_reports import ClaimedOutcome, Claims, Report, Source, TestRun
from autograder.probes.versions import Version
from autograder.sandbox import Ending

RIGHT = Version({"half/__init__.py": "def half(x):\n    return x / 2\n"}, {"half": "half.main"})
FILES = {
    "setup.py": b"",
    "test/conftest.py": b"import pytest",
    "test/helpers/limits.csv": b"0.3",
    "test/test_half.py": b"from half import half",
    "test/test_other.py": b"import test_shared",
    "test/test_shared.py": b"SPEED = 0.3",
}
SOURCE = Source("half", FILES)
HALF, OTHER = TestRun(("test_half.py",), RIGHT), TestRun(("test_other.py",), RIGHT)
REPORT = Report(Ending.EXITED, 0, Claims({"test_half::test_odd": ClaimedOutcome.PASSED}), 0, "1 passed")


@pytest.fixture
def memory(tmp_path: Path) -> Memory:
    """A memory of the two runs."""
    memory = Memory(tmp_path / "memory")
    for order in (HALF, OTHER):
        memory.keep(SOURCE, order, REPORT)
    return memory


def changed(name: str, text: bytes = b"# another") -> Source:
    return Source("half", {**FILES, name: text})


def test_the_same_run_is_recalled_whole(memory: Memory) -> None:
    assert (
        memory.recall(Source("half", dict(FILES)), TestRun(("test_half.py",), Version(*vars(RIGHT).values()))) == REPORT
    )


@pytest.mark.parametrize("name", ["test/test_half.py", "test/conftest.py", "test/helpers/limits.csv", "test/new.py"])
def test_a_file_that_its_tests_can_read_makes_it_another_run(memory: Memory, name: str) -> None:
    assert memory.recall(changed(name), HALF) is None


@pytest.mark.parametrize("name", ["setup.py", "test/test_other.py", "test/test_new.py"])
def test_a_file_that_they_cannot_know_does_not(memory: Memory, name: str) -> None:
    assert memory.recall(changed(name), HALF) == REPORT


def test_tests_that_name_another_file_can_read_it(memory: Memory) -> None:
    assert memory.recall(changed("test/test_shared.py"), OTHER) is None
    assert memory.recall(changed("test/test_half.py"), OTHER) == REPORT
    through_conftest = changed("test/conftest.py", b"from test_shared import SPEED")
    memory.keep(through_conftest, HALF, REPORT)
    later = {**through_conftest.files, "test/test_shared.py": b"SPEED = 0.4"}
    assert memory.recall(Source("half", later), HALF) is None


@pytest.mark.parametrize(
    "order",
    [
        replace(HALF, version=Version({"half/__init__.py": "def half(x):\n    return x // 2\n"}, RIGHT.scripts)),
        replace(HALF, version=Version(RIGHT.files, {"half": "half.other"})),
        *(replace(HALF, **{flag: True}) for flag in ("backwards", "first_failure", "sniffed")),
        replace(HALF, conftest=False),
        replace(HALF, files=("test_half.py", "test_other.py")),
    ],
)
def test_another_version_or_way_to_run_is_another_run(memory: Memory, order: TestRun) -> None:
    assert memory.recall(SOURCE, order) is None


def test_the_students_own_build_is_no_version_that_is_known(memory: Memory) -> None:
    own = replace(HALF, version=None)
    memory.keep(SOURCE, own, REPORT)
    assert memory.recall(SOURCE, own) is None


def test_a_run_that_had_to_be_stopped_is_not_kept(tmp_path: Path) -> None:
    memory = Memory(tmp_path)
    memory.keep(SOURCE, HALF, replace(REPORT, ending=Ending.WALL_TIME))
    assert memory.recall(SOURCE, HALF) is None


def test_who_gets_marks_has_no_memory() -> None:
    memory = Memory(None)
    memory.keep(SOURCE, HALF, REPORT)
    assert memory.recall(SOURCE, HALF) is None
