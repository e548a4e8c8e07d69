"""ROS 2 is found, described and switched on in one place, for wheels and for a sourced installation."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.ros import RosEnvironment, find
from autograder.ros.distribution import DISTRIBUTION
from autograder.ros.environment import without_wheel_bootstrap

ROOT = Path(__file__).parents[3]
ROS = RosEnvironment("wheels", (Path("/venv"),), Path("/venv/lib/rclpy"))
ROS_VARIABLES = ("ROS_", "AMENT_", "CMAKE_PREFIX", "FASTDDS_", "RCUTILS_", "RMW_", "PYTHONPATH")


def run_python(code: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run code in a new Python whose only ROS variables are `variables`."""
    clean = {name: value for name, value in os.environ.items() if not name.startswith(ROS_VARIABLES)}
    return subprocess.run(
        [sys.executable, "-c", code], env={**clean, **variables}, capture_output=True, text=True, timeout=120
    )


def test_the_wheels_of_this_virtual_environment_are_found() -> None:
    completed = run_python(
        "from autograder.ros import find; ros = find(); print(ros.kind, *ros.prefixes); print(ros.describe())"
    )
    assert completed.stdout.splitlines() == [
        f"wheels {sys.prefix}",
        f"ROS 2 {DISTRIBUTION.title}, wheels in {sys.prefix}",
    ], completed.stderr


def test_activating_is_enough_to_start_a_node() -> None:
    code = """
from autograder.ros import activate
activate(domain=17); activate(domain=17)
import os, rclpy
rclpy.init()
node = rclpy.create_node("lonely")
print(node.get_fully_qualified_name(), rclpy.utilities.get_rmw_implementation_identifier(), os.environ["ROS_DOMAIN_ID"])
rclpy.shutdown()
"""
    completed = run_python(code)
    assert completed.stdout.split() == ["/lonely", "rmw_fastrtps_cpp", "17"], completed.stderr


def test_activating_keeps_the_log_folder_and_the_transport_that_the_user_chose() -> None:
    code = """
import os
from autograder.ros import activate
activate()
print(os.environ["ROS_LOG_DIR"], os.environ["FASTDDS_BUILTIN_TRANSPORTS"], os.environ["ROS_DISTRO"])
"""
    completed = run_python(code, ROS_LOG_DIR="/chosen", FASTDDS_BUILTIN_TRANSPORTS="LARGE_DATA")
    assert completed.stdout.split() == ["/chosen", "LARGE_DATA", DISTRIBUTION.name], completed.stderr


@pytest.mark.promise(
    "In a terminal of JupyterLab, `ros2` and `colcon` work too.",
    "runs the same checks, and `ros2` and `colcon` work too",
)
def test_activating_finds_the_programs_of_this_python_by_their_names() -> None:
    code = """
import os, shutil
from autograder.ros import activate
before = shutil.which("colcon")
activate(); activate()
print(before, shutil.which("colcon"), shutil.which("ros2"))
print(os.environ["PATH"].split(os.pathsep).count(os.path.dirname(shutil.which("colcon"))))
"""
    completed = run_python(code, PATH="/usr/bin:/bin")
    scripts = Path(sys.executable).parent
    assert completed.stdout.split() == ["None", str(scripts / "colcon"), str(scripts / "ros2"), "1"], completed.stderr


FIND = """
from autograder.ros import RosError, find
try:
    ros = find()
    print(ros.kind, ros.describe(), *ros.prefixes)
except RosError as error:
    print(type(error).__name__, error)
"""


@pytest.fixture
def foreign_rclpy(tmp_path: Path) -> Path:
    """A folder outside the virtual environment from which rclpy would be imported, as when a ROS is sourced."""
    (tmp_path / "rclpy").mkdir()
    (tmp_path / "rclpy" / "__init__.py").touch()
    return tmp_path


def test_a_sourced_ros_wins_over_the_wheels(foreign_rclpy: Path) -> None:
    prefixes = os.pathsep.join(["/home/me/ws/install", str(foreign_rclpy), "/opt/more"])
    completed = run_python(
        FIND, PYTHONPATH=str(foreign_rclpy), ROS_DISTRO=DISTRIBUTION.name, AMENT_PREFIX_PATH=prefixes
    )
    description = f"sourced ROS 2 {DISTRIBUTION.title}, sourced from {foreign_rclpy} {foreign_rclpy} /opt/more"
    assert completed.stdout.strip() == description, completed.stderr


@pytest.mark.parametrize(("distro", "named"), [("humble", "is humble"), ("", "of no known distribution")])
def test_another_distribution_is_refused_by_name(foreign_rclpy: Path, distro: str, named: str) -> None:
    completed = run_python(FIND, PYTHONPATH=str(foreign_rclpy), ROS_DISTRO=distro, AMENT_PREFIX_PATH="/opt/ros/other")
    assert completed.stdout.startswith("WrongDistroError the sourced ROS 2 "), completed.stderr
    assert named in completed.stdout
    assert f"source {DISTRIBUTION.setup}" in completed.stdout


def test_a_half_sourced_ros_is_reported_with_its_missing_parts(foreign_rclpy: Path) -> None:
    completed = run_python(FIND, PYTHONPATH=str(foreign_rclpy), ROS_DISTRO=DISTRIBUTION.name)
    assert completed.stdout.startswith(
        f"RosNotFoundError rclpy is at {foreign_rclpy / 'rclpy'}, but not in AMENT_PREFIX_PATH"
    )


def test_without_any_ros_the_message_says_what_to_do() -> None:
    hide = "import sys, autograder.ros; sys.path = [entry for entry in sys.path if 'site-packages' not in entry]\n"
    completed = run_python(hide + FIND)
    assert completed.stdout.startswith("RosNotFoundError rclpy cannot be imported: run `make setup`"), completed.stderr


def test_child_processes_get_overlays_first_and_only_requested_variables() -> None:
    variables = ROS.variables(overlays=(Path("/near"), Path("/far")), domain=232, log_dir=Path("/logs"))
    assert variables["AMENT_PREFIX_PATH"] == variables["CMAKE_PREFIX_PATH"] == "/near:/far:/venv"
    assert (variables["ROS_DOMAIN_ID"], variables["ROS_LOG_DIR"]) == ("232", "/logs")
    assert "ROS_DOMAIN_ID" not in ROS.variables()


def test_another_environment_gets_the_libraries_of_a_sourced_ros_but_not_those_of_the_wheels() -> None:
    sourced = {"LD_LIBRARY_PATH": "/opt/ros/sourced/lib", "HOME": "/home/me"}
    assert without_wheel_bootstrap(sourced) == sourced
    assert without_wheel_bootstrap({**sourced, "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}) == {"HOME": "/home/me"}


@pytest.mark.parametrize("domain", [-1, 233])
def test_a_domain_without_ports_is_refused(domain: int) -> None:
    with pytest.raises(ValueError, match=f"ROS_DOMAIN_ID must be 0 to 232, not {domain}"):
        ROS.variables(domain=domain)


def test_each_test_has_a_domain_whose_ports_linux_does_not_give_to_other_programs(ros_domain: int) -> None:
    assert 1 <= ros_domain <= 101
    assert os.environ["ROS_DOMAIN_ID"] == str(ros_domain)


def run_with_ros(*command: str) -> subprocess.CompletedProcess[str]:
    """Run a command by `autograder ros`."""
    full_command = [sys.executable, "-m", "autograder", "ros", *command]
    return subprocess.run(full_command, capture_output=True, text=True, timeout=120, cwd=ROOT)


def test_a_command_runs_with_ros_activated_and_its_exit_status_is_returned() -> None:
    completed = run_with_ros("sh", "-c", 'echo "$AMENT_PREFIX_PATH"; command -v colcon; exit 7')
    prefix = find().prefixes[0]
    assert (completed.returncode, completed.stdout.split()) == (
        7,
        [str(prefix), str(Path(sys.prefix) / "bin" / "colcon")],
    )


@pytest.mark.promise('eval "$(.venv/bin/autograder ros)"')
def test_without_a_command_the_variables_are_printed_for_a_shell() -> None:
    script = f'eval "$({sys.executable} -m autograder.ros)" && python -c "import os; print(os.environ[\'ROS_DISTRO\'])"'
    completed = subprocess.run(["bash", "-c", script], capture_output=True, text=True, timeout=120, cwd=ROOT)
    assert completed.stdout.split() == [DISTRIBUTION.name], completed.stderr


def test_logs_go_to_stderr_in_a_terminal_and_to_stdout_in_a_notebook(monkeypatch: pytest.MonkeyPatch) -> None:
    name = "RCUTILS_LOGGING_USE_STDOUT"
    monkeypatch.delenv(name)
    assert run_with_ros("sh", "-c", f"echo ${name}").stdout == "\n"
    kernel = f"import os; from autograder.notebook import ros; ros(); print(os.environ['{name}'])"
    assert run_with_ros(sys.executable, "-c", kernel).stdout == "1\n"


def test_a_missing_command_is_named() -> None:
    completed = run_with_ros("no-such-command")
    assert (completed.returncode, completed.stderr) == (127, "no-such-command: No such file or directory\n")


def test_no_command_runs_without_a_usable_ros(foreign_rclpy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(foreign_rclpy))
    monkeypatch.setenv("ROS_DISTRO", "rolling")
    completed = run_with_ros("echo", "ran")
    assert (completed.returncode, completed.stdout) == (1, "")
    assert completed.stderr.startswith(f"ROS 2: the sourced ROS 2 is rolling, the course needs {DISTRIBUTION.title}")
