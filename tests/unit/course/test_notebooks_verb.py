"""`autograder notebooks` reports how each notebook and form ran, and its exit status is the worst of them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from autograder import cli, course_paths
from autograder.course_paths import Course

from .notebooks import chapter, code, notebook, solution

pytestmark = pytest.mark.slow  # kernels are started


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A course with one chapter, whose notebook runs in its solved form but not in its released one."""
    answer = code("# BEGIN SOLUTION\nanswer = 42\n# END SOLUTION", "answer", nbgrader=solution("answer"))
    chapter(tmp_path, notebook(answer, code("print(answer)", "use")))
    monkeypatch.setattr(course_paths, "course", lambda: Course(tmp_path, "small", "A small course"))
    return tmp_path


def _run(*arguments: str) -> Result:
    return CliRunner().invoke(cli.group, ["notebooks", *arguments])


def test_the_named_forms_run_and_a_failed_form_is_reported_with_its_cell(course: Path) -> None:
    completed = _run("--solved", "--released", "-j", "2", "--json", str(course / "runs.json"))
    assert completed.exit_code == 1
    assert "01_small (solved): ok in " in completed.output
    assert "01_small (released): failed in " in completed.output
    assert "cell 'answer': " in completed.output
    runs = json.loads((course / "runs.json").read_text())
    assert [(run["assignment"], run["form"], run["failure"] is None) for run in runs] == [
        ("01_small", "solved", True),
        ("01_small", "released", False),
    ]
    reports = {path.name for path in (course / ".build" / "notebooks").iterdir()}
    assert reports == {"01_small-solved.ipynb", "01_small-released.ipynb"}


def test_several_notebooks_run_at_once_each_in_its_own_domain(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "place"
    folder.mkdir()
    # Each waits for the other: if run one after another, both would fail.
    rendezvous = f"""import os, time
from pathlib import Path
Path('{folder}', os.environ['ROS_DOMAIN_ID']).touch()
end = time.monotonic() + 60
while len(list(Path('{folder}').iterdir())) < 2 and time.monotonic() < end:
    time.sleep(0.01)
assert len(list(Path('{folder}').iterdir())) == 2"""
    chapter(tmp_path, notebook(code(rendezvous, "meet")))
    monkeypatch.setattr(course_paths, "course", lambda: Course(tmp_path, "small", "A small course"))
    completed = _run("--source", "--solved", "-j", "2")
    assert completed.exit_code == 0, completed.output
    assert sorted(line.partition(": ")[0] for line in completed.output.splitlines()) == [
        "01_small (solved)",
        "01_small (source)",
    ]


def test_without_a_form_the_source_runs(course: Path) -> None:
    completed = _run("01_small")
    assert completed.exit_code == 0, completed.output
    assert completed.output.startswith("01_small (source): ok in ")


def test_an_unknown_assignment_is_refused_with_the_known_ones(course: Path) -> None:
    assert "there are: 01_small" in str(_run("1_small").exception)
