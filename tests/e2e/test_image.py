"""The image of a student release, built and run by buildah.

ROS2_IMAGE names an image that `make image` has built. Otherwise the tests build one, which takes minutes.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner

from autograder import course_paths
from autograder.author.verification.mutants import write_reference
from autograder.cli import group
from autograder.suite import suites
from tests.e2e.containers import Container, buildah, container, end_of

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.timeout(7200),
    pytest.mark.skipif(os.geteuid() != 0, reason="only root can build an image and run its programs"),
]
SCRIPTS = course_paths.ROOT / "assets" / "image"
ASSIGNMENT = "02_nodes"
COURSE = "/home/student/course"
STUDENT = "1000:1000"


@pytest.fixture(scope="module")
def image(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The name of an image of a student release."""
    if name := os.environ.get("ROS2_IMAGE"):
        return name
    name, release = "localhost/ros2-python-course-tested", tmp_path_factory.mktemp("image") / "course"
    ran = CliRunner().invoke(group, ["release", "--out", str(release)])
    assert ran.exit_code == 0, ran.output
    built = subprocess.run([SCRIPTS / "build", release, name], capture_output=True, text=True, check=False)
    assert built.returncode == 0, end_of(built)
    return name


@pytest.fixture(scope="module")
def course(image: str) -> Iterator[Container]:
    """A container of the image."""
    with container(image) as made:
        yield made


def entry_point(image: str) -> list[str]:
    """Return the words before each command that a container of the image starts."""
    words: list[str] = json.loads(buildah("inspect", "--type", "image", image).stdout)["OCIv1"]["config"]["Entrypoint"]
    return words


@pytest.mark.promise("The image activates ROS for everything that it starts, and sets `JUPYTER_CONFIG_PATH`.")
def test_programs_of_the_image_run_as_a_student_and_with_ros(course: Container, image: str) -> None:
    code = "import autograder, sim, rclpy, os; print(os.getuid(), os.environ['JUPYTER_CONFIG_PATH'], sim.__file__)"
    done = course.run(*entry_point(image), "python", "-W", "error", "-c", code)
    assert done.returncode == 0, end_of(done)
    assert done.stdout.split() == [
        "1000",
        f"{COURSE}/jupyter:{COURSE}/assets/students/jupyter",
        f"{COURSE}/sim/__init__.py",
    ]
    files = set(os.listdir(course.root / COURSE.lstrip("/")))
    assert "chapters" in files
    assert "solutions" not in files


@pytest.mark.promise("In it, `autograder doctor` reports that nothing is missing")
def test_the_doctor_finds_nothing_missing_in_the_image(course: Container) -> None:
    done = course.run("autograder", "doctor", "--json", "/tmp/doctor.json")
    assert done.returncode == 0, end_of(done)
    findings = json.loads((course.root / "tmp" / "doctor.json").read_text())
    # No browser, because students use their own; and the kernel forbids namespaces in buildah's chroot.
    assert {each["name"] for each in findings if each["status"] != "ok"} <= {"isolation", "browser"}


@pytest.mark.promise("`autograder check 02_nodes` passes a reference answer")
def test_a_reference_answer_passes_the_check_in_the_image(course: Container, tmp_path: Path) -> None:
    write_reference(suites.visible(ASSIGNMENT).sources, tmp_path)
    course.copy(tmp_path, f"{COURSE}/chapters/{ASSIGNMENT}/ws", STUDENT)
    done = course.run("autograder", "check", ASSIGNMENT)
    assert done.returncode == 0, end_of(done)


def test_a_released_notebook_runs_to_its_end_in_the_image(course: Container) -> None:
    program = ("jupyter", "nbconvert", "--to", "notebook", "--execute", "--ExecutePreprocessor.timeout=600")
    done = course.run(
        *("autograder", "ros", *program, "--output-dir", "/tmp", "00_welcome.ipynb"),
        folder=f"{COURSE}/chapters/00_welcome",
    )
    assert done.returncode == 0, end_of(done)
    executed = json.loads((course.root / "tmp" / "00_welcome.ipynb").read_text())
    cells = [cell for cell in executed["cells"] if cell["cell_type"] == "code"]
    assert cells
    assert all(cell["execution_count"] for cell in cells if "".join(cell["source"]).strip())
