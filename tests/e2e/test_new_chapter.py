"""A new chapter works without changes, and the tutorial's commands print what the tutorial says."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from autograder import course_paths

DOCS = course_paths.ROOT / "docs"
BLOCKS = re.compile(r"^```(sh|text)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def shell(script: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a script as the tutorial's reader does, with the commands of this environment on the path."""
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    return subprocess.run(["bash", "-euc", script], cwd=folder, env=environment, text=True, capture_output=True)


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A new course with two new chapters, one of which has custom names."""
    folder = tmp_path_factory.mktemp("new")
    new = "autograder --course mine new chapter"
    script = f"autograder new course mine\n{new} 10_mapping\n{new} 18_launch --package launch_lab --node watcher"
    process = shell(script, folder)
    assert process.returncode == 0, process.stderr
    return folder / "mine"


def autograder(course: Path, arguments: str) -> subprocess.CompletedProcess[str]:
    return shell(f"autograder --course {course} {arguments}", course.parent)


@pytest.mark.promise(
    "`autograder new chapter 10_mapping` creates a small, working chapter",
    "`autograder --course FOLDER VERB` selects the course for any verb.",
    "The new chapter is small but complete.",
    "autograder course tables",
    "autograder course check",
)
def test_a_new_chapter_passes_every_check_of_the_course(course: Path) -> None:
    check = autograder(course, "course check")
    assert (check.returncode, check.stdout) == (0, "")
    tables = autograder(course, "course tables")
    assert (tables.returncode, tables.stdout) == (0, "")
    page = (course / "chapters" / "README.md").read_text()
    assert "| Mapping | 10_mapping | Exercise | `nearest`, `counts`, `silent` |" in page


def test_a_new_chapter_contains_no_placeholder_of_the_template(course: Path) -> None:
    files = (path for path in course.rglob("*") if path.is_file() and not {".build", "__pycache__"} & set(path.parts))
    texts = {path: path.read_text() for path in files}
    assert len(texts) > 50
    assert [path for path, text in texts.items() if "NEW_" in f"{path}{text}" or "TODO" in text] == []


@pytest.mark.promise("`autograder new course FOLDER` also writes a README with the commands")
def test_the_commands_of_a_new_courses_readme_and_workflow_exist(course: Path) -> None:
    readme, workflow = (course / "README.md").read_text(), course / ".github" / "workflows" / "ci.yml"
    steps = yaml.safe_load(workflow.read_text())["jobs"]["course"]["steps"]
    inline = re.findall(r"`(autograder [^`]+)`", readme)
    workflow_commands = [step["run"] for step in steps if step.get("run", "").startswith("autograder ")]
    assert len(workflow_commands) == 3
    assert {*workflow_commands} <= {*inline}
    process = shell("\n".join(f"{command} --help" for command in inline), course)
    assert process.returncode == 0, process.stderr


def test_git_ignores_what_is_built_in_a_new_course(course: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(course, tmp_path / "copy")
    built = [
        ".build/verify.json",
        "chapters/10_mapping/ws/install/setup.sh",
        "checks/__pycache__/x.pyc",
        "gradebook.db",
    ]
    ignored = shell(f"git init -q\ngit check-ignore {' '.join(built)}", copy)
    assert ignored.stdout.split() == built
    not_ignored = shell("git ls-files --others --exclude-standard", copy).stdout.split()
    assert {".gitignore", ".github/workflows/ci.yml", "README.md", "course.yaml", "syllabus.yaml"} <= {*not_ignored}


@pytest.mark.promise(
    "Without `--only`, `verify` also generates small errors in everything that students write",
    "Without `--quick`, `verify` also generates mutants",
)
@pytest.mark.slow
def test_verify_lists_the_generated_mutants_that_no_check_fails(course: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(course, tmp_path / "copy")
    node = copy / "solutions" / "mapping" / "mapping" / "nearest.py"
    condition = "reading <= scan.range_max"
    node.write_text(node.read_text().replace(condition, f"{condition} and reading < 1e9"))  # no check publishes 1e9 m
    process = autograder(copy, "verify --assignment 10_mapping --mutants -j 2")
    assert process.returncode == 1
    survivors = re.findall(r"survives without a reason\n.*\n.*\n +\+ (.*)$", process.stderr, re.MULTILINE)
    assert f"return scan.range_min <= {condition} and (reading <= 1e9)" in survivors, process.stderr
    killed_count, count = map(int, re.findall(r"(\d+) of (\d+) mutants killed", process.stdout)[0])
    assert (count > 20, count - killed_count) == (True, len(survivors)), process.stdout


@pytest.mark.promise(
    "`--named` grades everything except the generated mutants.", "autograder verify --assignment 10_mapping"
)
@pytest.mark.slow
def test_verify_can_leave_out_the_generated_mutants(course: Path) -> None:
    process = autograder(course, "verify --assignment 10_mapping --named -j 2")
    assert process.returncode == 0, process.stdout + process.stderr
    names = re.findall(r"^10_mapping (reference|release|variant|mutant) .* as expected$", process.stdout, re.MULTILINE)
    assert {*names} == {"reference", "release", "variant", "mutant"}
    assert "killed" not in process.stdout


@pytest.mark.promise(
    "Without `--only`, `verify` also generates small errors in everything that students write",
    "Without `--quick`, `verify` also generates mutants",
)
@pytest.mark.nightly
def test_every_mutant_of_new_chapters_is_killed(course: Path) -> None:
    process = autograder(course, "verify -j 2")
    assert process.returncode == 0, process.stdout + process.stderr
    for chapter in ("10_mapping", "18_launch"):
        for name in ("reference", "release", "variant loop", "mutant farthest"):
            assert re.search(f"^{chapter} {name} .* as expected$", process.stdout, re.MULTILINE), process.stdout
    assert "0 without a reason" in process.stdout


@pytest.mark.promise("autograder notebooks --source --released 10_mapping")
def test_the_notebook_of_a_new_chapter_runs_as_source_and_as_released(course: Path) -> None:
    process = autograder(course, "notebooks --source --released -j 2 18_launch")
    assert process.returncode == 0, process.stdout + process.stderr


@pytest.mark.promise("A package called `launch` would hide ROS's own")
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("chapter mapping", "'mapping' is not a chapter name: use two digits and a name, such as 10_mapping"),
        ("chapter 11_import", "'11_import' is not a chapter name"),
        ("chapter 11_mapping", "solutions/mapping already exists: choose another name"),
        (
            "chapter 19_launch",
            "a package cannot be called 'launch', which is a package of ROS. "
            "Choose another name: autograder new chapter 19_launch --package my_launch",
        ),
        ("course mine", "mine already exists: choose another name"),
    ],
    # A test whose id contains a chapter's name runs on another worker, which would create the course again.
    ids=["no number", "a keyword", "the package exists", "a package of ROS", "the course exists"],
)
def test_an_invalid_name_of_a_new_chapter_is_refused_and_nothing_is_written(
    course: Path, arguments: str, message: str
) -> None:
    before = {*course.rglob("*")}
    process = autograder(course, f"new {arguments}")
    assert process.returncode == 2
    assert message in process.stderr
    assert {*course.rglob("*")} == before


@pytest.mark.promise("Its package is called `mapping` and its node `nearest`, unless")
def test_the_package_and_the_node_of_a_new_chapter_have_the_given_names(course: Path) -> None:
    package = course / "solutions" / "launch_lab"
    assert "'watcher = launch_lab.watcher:main'" in (package / "setup.py").read_text()
    program = (package / "launch_lab" / "watcher.py").read_text()
    assert "class Watcher(Node):" in program
    assert "super().__init__('watcher')" in program
    assert (course / "chapters" / "18_launch" / "ws" / "src" / "launch_lab" / "package.xml").is_file()
    assert "  launch_lab: Launch\n" in (course / "syllabus.yaml").read_text()


@pytest.mark.promise(
    "The variable tells `autograder` which course to use.",
    "The reference and the variant get all points, the untouched student release gets none",
    "`--record` writes all checks that the error fails to `mutants.snapshot.yaml`.",
    "`autograder verify --assignment 02_nodes --only index_zero_is_forward` grades a single mutant",
    "`sync` updates the notebook, and `tables` the lists of checks",
    "`course check` takes a second, and reports all mistakes in a chapter",
    "`graded/ada/feedback.html` shows the check, your hint, and the requirement from the notebook.",
    "This command creates the student release, which has no hidden checks and no answers:",
    "autograder course sync",
    "autograder release 10_mapping --out ../release",
)
def test_every_command_of_the_tutorial_prints_what_the_page_says(tmp_path: Path) -> None:
    compare_with_page(DOCS / "first_check.md", tmp_path, 9)
    assert "The node is called nearest." in (tmp_path / "graded" / "ada" / "feedback.html").read_text()
    assert not [*(tmp_path / "students").rglob("hidden")]


@pytest.mark.promise(
    "A package called `launch` would hide ROS's own",
    "`%%writefile` makes the folder `launch`.",
    "a release that does not build is not as expected",
    "`course check` finds a text that does not occur in the reference",
)
@pytest.mark.nightly
def test_every_command_of_the_tutorial_about_launch_prints_what_the_page_says(tmp_path: Path) -> None:
    compare_with_page(DOCS / "first_launch_check.md", tmp_path, 7)


def compare_with_page(page: Path, folder: Path, lines: int) -> None:
    """Run a page's commands in an empty folder; require that they print the page's output, which has `lines` lines."""
    blocks = BLOCKS.findall(page.read_text(encoding="utf-8"))
    script = "".join(f"{text}\necho =====\n" for kind, text in blocks if kind == "sh")
    process = shell(script, folder)
    assert process.returncode == 0, process.stdout + process.stderr
    outputs = iter(process.stdout.split("=====\n"))
    output, compared = "", 0
    for kind, text in blocks:
        if kind == "sh":
            output = " ".join(next(outputs).split())
            continue
        for line in text.splitlines():
            assert line in output, f"the page says {line!r}, but the command printed {output}"
            compared += 1
    assert compared == lines
