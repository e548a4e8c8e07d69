"""A class on a JupyterHub with users of this machine, from their login to the marks in the teacher's gradebook."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import nbformat
import pytest

from autograder import course_paths
from autograder.bootstrap import closed_to_other_users
from autograder.lms.hub.trial import Hub, serving
from autograder.suite import suites
from tests.e2e.classroom import fill_in
from tests.e2e.hub_client import User

ASSIGNMENT = "02_nodes"
COURSE = {"course_id": "ros2-python", "assignment_id": ASSIGNMENT}
SOLUTION = "robot-controller"
FLAW, FAILED_CHECK = ("HALF_SECTOR = math.radians(30.0)", "HALF_SECTOR = math.radians(33.0)"), "only_forward_counts"
# Prints the kernel's folder and domain, and whether it can write to the installation.
REPORT = (
    "import os, sys; print(os.path.basename(os.getcwd()), os.environ['ROS_DOMAIN_ID'], os.access(sys.prefix, os.W_OK))"
)

CLOSED = closed_to_other_users(Path(sys.executable).resolve(), course_paths.ROOT)
ON_A_HUB = [
    pytest.mark.skipif(os.geteuid() != 0, reason="only root can start the servers of other users"),
    pytest.mark.skipif(CLOSED is not None, reason=str(CLOSED)),
]
pytestmark = [pytest.mark.slow, pytest.mark.timeout(1800), *ON_A_HUB]


@pytest.fixture
def shared_folder() -> Iterator[Path]:
    """A folder that other users can enter, unlike pytest's."""
    folder = Path(tempfile.mkdtemp(dir="/tmp"))
    folder.chmod(0o755)
    yield folder
    shutil.rmtree(folder)


def submit(student: User, *, flawed: bool) -> list[str]:
    """Fetch, solve, run and submit the assignment; return what `REPORT` prints, as words."""
    student.nbgrader("assignments/fetch", data=COURSE)
    path = f"{ASSIGNMENT}/{ASSIGNMENT}.ipynb"
    notebook = nbformat.from_dict(student.request("GET", f"api/contents/{path}")["content"])
    fill_in(notebook, ASSIGNMENT)
    answer = next(cell for cell in notebook.cells if cell.id == SOLUTION)
    if flawed:
        assert answer.source.count(FLAW[0]) == 1
        answer.source = answer.source.replace(*FLAW)
    student.request("PUT", f"api/contents/{path}", json={"type": "notebook", "content": notebook})
    setup_cell = next(cell for cell in notebook.cells if "ros()" in cell.source)
    *_, report, imported = student.run(
        path, setup_cell.source, answer.source, REPORT, "import rclpy; print(rclpy.__name__)"
    )
    assert imported == "rclpy\n"
    student.nbgrader("assignments/submit", data=COURSE)
    return report.split()


def run_outside_the_hub(student: User, *arguments: str) -> str:
    """Run autograder as the student, as after a login by SSH; return its output."""
    command = [str(Path(sys.executable).with_name("autograder")), *arguments]
    environment = {"PATH": os.defpath, "HOME": str(student.hub.homes / student.name)}
    return subprocess.check_output(command, user=student.name, env=environment, cwd="/", text=True).strip()


def check_a_class(hub: Hub, *, with_reference: bool) -> None:
    """Let students submit, and the teacher grade with formgrader and release the feedback.

    Args:
        hub: a running hub, to which nobody has logged in yet.
        with_reference: whether a student submits the reference, in addition to one with a flawed answer.
    """
    teacher = User(hub, hub.teacher).log_in()
    for step in ("assign", "release"):
        teacher.nbgrader(f"formgrader/api/assignment/{ASSIGNMENT}/{step}")
    ada, ben = (User(hub, name).log_in() for name in hub.students[:2])
    folder, domain, can_write = submit(ben, flawed=True)
    assert (folder, can_write) == (ASSIGNMENT, "False")
    assert ben.in_terminal("printenv ROS_DOMAIN_ID") == domain
    assert run_outside_the_hub(ben, "ros", "printenv", "ROS_DOMAIN_ID") == domain
    assert ben.in_terminal("type -t autograder ros2 colcon | sort -u") == "file"
    assert ada.in_terminal("printenv ROS_DOMAIN_ID") != domain
    if with_reference:
        submit(ada, flawed=False)

    teacher.nbgrader(f"formgrader/api/assignment/{ASSIGNMENT}/collect")
    marks = {}
    for student in (ada, ben) if with_reference else (ben,):
        teacher.nbgrader(f"formgrader/api/submission/{ASSIGNMENT}/{student.name}/autograde")
        recorded = teacher.request("GET", f"formgrader/api/submission/{ASSIGNMENT}/{student.name}")
        assert recorded["max_score"] == suites.hidden(ASSIGNMENT).max_score
        marks[student.name] = recorded["score"]
    suite = suites.hidden(ASSIGNMENT)
    assert marks[ben.name] == suite.max_score - sum(check.points for check in suite.checks if check.id == FAILED_CHECK)
    if with_reference:
        assert marks[ada.name] == suite.max_score

    for step in ("generate_feedback", "release_feedback"):
        teacher.nbgrader(f"formgrader/api/assignment/{ASSIGNMENT}/{step}")
    ben.nbgrader("assignments/fetch_feedback", data=COURSE)
    assignments = ben.request("GET", f"assignments?course_id={COURSE['course_id']}")["value"]
    (submission,) = (
        submission
        for assignment in assignments
        if assignment["status"] == "submitted"
        for submission in assignment["submissions"]
    )
    page = ben.read(f"{submission['local_feedback_path']}/{ASSIGNMENT}.html")
    assert f"(Score: {marks[ben.name]:.1f} / {suite.max_score:.1f})" in page


@pytest.mark.promise(
    "This starts a hub on this machine alone, with three students and a teacher",
    "`autograder ros jupyterhub-singleuser`",
    "`autograder`, `ros2` and `colcon` work in each terminal.",
    "A login by SSH is in the same domain",
)
def test_students_submit_and_the_teacher_grades_on_a_hub(shared_folder: Path) -> None:
    with serving(shared_folder, course_paths.ROOT) as hub:
        check_a_class(hub, with_reference=False)
    users = Path("/etc/passwd").read_text()
    assert not any(name in users for name in (*hub.students, hub.teacher))
