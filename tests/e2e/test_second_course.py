"""The same commands check, verify, grade and release a course in another folder, and hide its answers."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.run.sandbox import Isolation

SECOND = course_paths.ROOT / "tests" / "second_course"
PACKAGES = {"01_greeting": "greeting", "02_beat": "beat"}  # the package of each assignment's answer
Run = Callable[..., "subprocess.CompletedProcess[str]"]


def run(*command: str, cwd: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, **variables}
    return subprocess.run([sys.executable, "-m", *command], cwd=cwd, env=environment, text=True, capture_output=True)


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The second course in a separate folder, updated."""
    course = tmp_path_factory.mktemp("second") / "course"
    shutil.copytree(SECOND, course, ignore=course_paths.NOT_COPIED)
    for verb in ("sync", "tables"):
        process = run("autograder", "--course", "course", "course", verb, cwd=course.parent)
        assert process.returncode == 0, process.stdout + process.stderr
    return course


@pytest.fixture
def autograder(course: Path, tmp_path: Path) -> Run:
    """Run a verb on the second course, from an unrelated folder."""
    return lambda *arguments, **variables: run(
        "autograder", *arguments, cwd=tmp_path, **{"AUTOGRADER_COURSE": str(course), **variables}
    )


def test_a_second_course_passes_its_check_and_its_tables_name_its_checks(course: Path, autograder: Run) -> None:
    check = autograder("course", "check")
    assert (check.returncode, check.stdout) == (0, "")
    assert "Write a node that beats | 02_beat" in (course / "chapters" / "README.md").read_text()
    assert "counts from 0" in (course / "checks.md").read_text()
    assert json.loads((course / "checks/ch02_beat/visible/hidden_titles.json").read_text()) == ["It counts its beats."]


@pytest.mark.nightly
def test_the_verification_of_a_second_course_succeeds(autograder: Run) -> None:
    process = autograder("verify", "--quick", "-j", "2", "--json", "verification.json")
    assert process.returncode == 0, process.stdout + process.stderr
    for name in PACKAGES:
        assert f"{name} reference" in process.stdout
    assert "01_greeting variant added" in process.stdout
    assert "02_beat mutant" in process.stdout


def test_a_mutant_that_costs_too_much_without_a_reason_fails_the_verification(
    course: Path, autograder: Run, tmp_path: Path
) -> None:
    changed_course = tmp_path / "course"
    shutil.copytree(course, changed_course)
    mutants = changed_course / "checks/ch01_greeting/mutants.yaml"
    mutants.write_text(mutants.read_text().replace("check: greets", "check: strips"))
    process = autograder("verify", "--only", "same_name", AUTOGRADER_COURSE=str(changed_course))
    assert process.returncode == 1
    assert re.search(r"^01_greeting mutant same_name +0/3 = 0 % +as expected$", process.stdout, re.MULTILINE)
    assert "mutant same_name: it loses 3 points, strips is worth 1, and no reason is given" in process.stderr


@pytest.mark.promise(
    "make demo",
    "`make demo` takes about three minutes the first time and ends with one line for each robot",
    "`.build/demo/` then holds the results as JSON.",
    "It also holds a feedback page for each robot",
)
def test_the_demo_ends_with_a_line_for_each_robot_and_writes_its_results(course: Path, autograder: Run) -> None:
    process = autograder("demo")
    assert process.returncode == 0, process.stdout + process.stderr
    rows = re.findall(r"^(reference|keeps_spaces|empty) +(\d/3|unclear)", process.stdout, re.MULTILINE)
    assert rows == [("reference", "3/3"), ("keeps_spaces", "2/3"), ("empty", "unclear")]
    folder = course / ".build" / "demo"
    assert [result["student"] for result in json.loads((folder / "results.json").read_text())] == [
        name for name, _ in rows
    ]
    assert all((folder / name / "feedback.html").is_file() for name, _ in rows)


@pytest.mark.promise("A chapter's checks are imported as `autograder.checks.chID`, wherever the course is.")
def test_feedback_of_a_second_course_quotes_the_contract_of_that_course(
    course: Path, autograder: Run, tmp_path: Path
) -> None:
    for student in ("ada", "ben"):
        package = tmp_path / "class" / student / "src" / "greeting"
        shutil.copytree(course / "solutions" / "greeting", package)
    greet = package / "greeting" / "greet.py"
    greet.write_text(greet.read_text().replace(".strip()", ""))
    process = autograder("grade", "class", "--assignment", "01_greeting", "--out", "graded", "-j", "2")
    assert process.returncode == 0, process.stderr
    results = {name: json.loads((tmp_path / "graded" / name / "result.json").read_text()) for name in ("ada", "ben")}
    assert [(result["score"], result["max_score"]) for result in results.values()] == [(3.0, 3.0), (2.0, 3.0)]
    assert "without spaces around it" in (tmp_path / "graded" / "ben" / "feedback.html").read_text()


def test_a_course_folder_without_course_yaml_is_refused(tmp_path: Path) -> None:
    process = run("autograder", "--course", "nowhere", "course", "check", cwd=tmp_path)
    assert (process.returncode, process.stderr) == (
        2,
        f"autograder: {tmp_path / 'nowhere'} is not a course: it has no course.yaml; --course names another one\n",
    )


@pytest.mark.promise("The environment variable `AUTOGRADER_COURSE` does the same")
def test_a_second_course_has_only_its_own_chapters(autograder: Run) -> None:
    process = autograder("grade", ".", "--assignment", "02_nodes", "--out", "graded")
    assert process.returncode == 2
    assert "there are for: 01_greeting, 02_beat" in process.stderr


@pytest.mark.promise("Sandboxes and student releases hide the hidden checks, the reference and the notebook sources")
def test_the_release_of_a_second_course_contains_no_answer_and_no_hidden_check(
    course: Path, autograder: Run, tmp_path: Path
) -> None:
    assert autograder("release", "--out", "bundle").returncode == 0
    release = tmp_path / "bundle"
    names = {path.name for path in (release / "checks").glob("ch*/*")}
    assert names == {"__init__.py", "support", "visible"}
    assert list((release / "autograder" / "checks").glob("ch*")) == []
    texts = "\n".join(path.read_text(errors="replace") for path in release.rglob("*") if path.is_file())
    for secret in ("Elektro", "{name.strip()}", "UInt32(data=self.count)"):
        assert secret not in texts
        assert any(secret in path.read_text() for path in course.rglob("*.py"))
    assert "# A second course" in (release / "README.md").read_text()

    chapter = release / "chapters" / "02_beat"
    check = run("autograder", "check", "02_beat", cwd=chapter, PYTHONPATH=str(release))
    assert "Its first beat is 1." in check.stdout, check.stderr
    assert check.returncode == 1


@pytest.mark.promise("Sandboxes and student releases hide the hidden checks, the reference and the notebook sources")
def test_a_sandbox_hides_checks_reference_and_notebooks_of_a_second_course(course: Path) -> None:
    code = (
        "import sys\n"
        "from pathlib import Path\n"
        "from autograder.run.sandbox import Mount, Sandbox\n"
        "from autograder.run.sandbox.launcher import launch\n"
        "course = Path(sys.argv[1])\n"
        "shown = Sandbox(course.parent, mounts=(Mount(course.parent),))\n"
        "with launch(['find', str(course), '-type', 'f'], shown) as listing:\n"
        "    listing.wait(None)\n"
        "    print(listing.output)\n"
    )
    variables = {"AUTOGRADER_COURSE": str(course), "AUTOGRADER_ISOLATION": Isolation.BUBBLEWRAP.value}
    command = [sys.executable, "-c", code, str(course)]
    process = subprocess.run(command, env={**os.environ, **variables}, text=True, capture_output=True, check=True)
    visible = {Path(line).relative_to(course).parts[0] for line in process.stdout.splitlines() if line}
    assert {"course.yaml", "syllabus.yaml"} <= visible
    assert visible.isdisjoint({"checks", "solutions", "chapters"})


def test_a_solved_notebook_of_a_second_course_runs_and_is_graded_as_a_submission(
    course: Path, autograder: Run, tmp_path: Path
) -> None:
    process = autograder("notebooks", "--solved", "01_greeting")
    assert process.returncode == 0, process.stdout + process.stderr
    submission = tmp_path / "ada" / "01_greeting.ipynb"
    submission.parent.mkdir()
    shutil.copy(course / ".build" / "notebooks" / "01_greeting-solved.ipynb", submission)
    graded = autograder("grade", "ada", "--assignment", "01_greeting", "--out", "graded")
    assert graded.returncode == 0, graded.stdout + graded.stderr


@pytest.mark.promise("also for nbgrader, JupyterLab and the workers of a cluster")
def test_nbgrader_records_the_marks_of_a_second_course(course: Path) -> None:
    def nbgrader(verb: str) -> None:
        process = run("nbgrader", verb, "01_greeting", cwd=course, AUTOGRADER_COURSE=str(course))
        assert process.returncode == 0, process.stderr

    nbgrader("generate_assignment")
    submitted = course / "submitted" / "ada" / "01_greeting"
    shutil.copytree(course / "release" / "01_greeting", submitted)
    shutil.copytree(course / "solutions" / "greeting", submitted / "ws" / "src" / "greeting", dirs_exist_ok=True)
    nbgrader("autograde")
    nbgrader("generate_feedback")
    exported = run("nbgrader", "export", "--to", "marks.csv", cwd=course, AUTOGRADER_COURSE=str(course))
    assert exported.returncode == 0, exported.stderr
    header, row = (line.split(",") for line in (course / "marks.csv").read_text().splitlines())
    assert (row[header.index("student_id")], row[header.index("score")]) == ("ada", "3.0")
