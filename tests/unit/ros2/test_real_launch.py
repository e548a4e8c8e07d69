"""The installation of the real launch, from local git repositories that replace the sources."""

from __future__ import annotations

import re
import socket
import subprocess
import sysconfig
import venv
from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.course_paths import ROOT
from autograder.ros import RosEnvironment, find, real_launch
from autograder.ros.launch_packages import SOURCES, Location, Source, describe_launch, python_packages
from autograder.ros.real_launch import RealLaunchError, install, main, remove, set_up

MANIFEST = """<package format="3"><name>{name}</name><version>1.0.0</version><description>Test</description>
<maintainer email="test@example.com">Test</maintainer><license>MIT</license>
<buildtool_depend>ament_cmake</buildtool_depend><export><build_type>{kind}</build_type></export></package>
"""
SETUP = """from setuptools import setup
setup(name='{name}', version='1.0.0', packages=['{name}'], tests_require=['pytest'],
      data_files=[('share/ament_index/resource_index/packages', ['resource/{name}'])])
"""
CMAKE = """cmake_minimum_required(VERSION 3.10)
project(made_interfaces NONE)
find_package(ament_cmake_core REQUIRED)
ament_package()
"""


def repository(folder: Path, files: dict[str, str], tag: str = "") -> Path:
    """Make a git repository with one commit."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    git = ["git", "-C", str(folder), "-c", "user.name=t", "-c", "user.email=t@example.com"]
    subprocess.run(["git", "init", "--quiet", str(folder)], check=True)
    subprocess.run([*git, "add", "."], check=True)
    subprocess.run([*git, "commit", "--quiet", "-m", "one"], check=True)
    if tag:
        subprocess.run([*git, "tag", tag], check=True)
    return folder


def commit_of(folder: Path) -> str:
    """Return the commit that is checked out."""
    completed = subprocess.run(
        ["git", "-C", str(folder), "rev-parse", "HEAD"], capture_output=True, text=True, check=True
    )
    return completed.stdout.strip()


def python_package(name: str, content: str) -> dict[str, str]:
    return {
        f"{name}/package.xml": MANIFEST.format(name=name, kind="ament_python"),
        f"{name}/setup.py": SETUP.format(name=name),
        f"{name}/resource/{name}": "",
        f"{name}/{name}/__init__.py": content,
    }


@pytest.fixture
def machine(tmp_path: Path) -> tuple[RosEnvironment, str]:
    """A separate virtual environment that sees the packages of this one, and ROS with its prefix in front."""
    prefix = tmp_path / "venv"
    venv.create(prefix, symlinks=True)
    python = str(prefix / "bin" / "python")
    packages = next(prefix.glob("lib/python*/site-packages"))
    (packages / "course.pth").write_text(sysconfig.get_path("purelib"))
    ros = find()
    return RosEnvironment("wheels", (prefix, *ros.prefixes), ros.rclpy), python


NO_GIT = "https://example.invalid/x.git"


@pytest.mark.promise("`make real-launch` installs the real ones")
@pytest.mark.slow
def test_packages_are_installed_from_the_sources_that_the_variables_name(
    tmp_path: Path, machine: tuple[RosEnvironment, str]
) -> None:
    ros, python = machine
    interfaces = {
        "made_interfaces/package.xml": MANIFEST.format(name="made_interfaces", kind="ament_cmake"),
        "made_interfaces/CMakeLists.txt": CMAKE,
    }
    interfaces_clone = repository(tmp_path / "interfaces", interfaces, tag="1.0.0")
    launch = repository(tmp_path / "launch", python_package("made_launch", "VERSION = 'tagged'"), tag="1.0.0")
    (launch / "made_launch" / "made_launch" / "__init__.py").write_text("VERSION = 'not committed'")
    sources = (
        Source("INTERFACES", NO_GIT, "1.0.0", commit_of(interfaces_clone), ("made_interfaces",), is_interface=True),
        Source("LAUNCH", NO_GIT, "1.0.0", commit_of(launch), ("made_launch",)),
    )
    environ = {"INTERFACES": str(interfaces_clone), "LAUNCH": str(launch)}
    names = install(ros, environ, python=python, sources=sources, requirement="")
    assert names == ["made_interfaces", "made_launch"]
    prefix = ros.prefixes[0]
    assert (prefix / "share/made_interfaces/package.xml").is_file()
    index = prefix / "share/ament_index/resource_index/packages/made_launch"
    assert index.is_file()
    code = "import made_launch; print(made_launch.VERSION)"
    printed = subprocess.run([python, "-c", code], capture_output=True, text=True, check=True)
    assert printed.stdout == "tagged\n"
    remove([*names, "never_installed"], python=python)
    assert not index.exists()


@pytest.mark.slow
def test_packages_that_cannot_all_be_installed_are_not_installed(
    tmp_path: Path, machine: tuple[RosEnvironment, str]
) -> None:
    ros, python = machine
    clone = repository(tmp_path / "clone", python_package("made_launch", "") | python_package("made_ros", ""), tag="1")
    (ros.prefixes[0] / "share/ament_index/resource_index/packages").mkdir(parents=True)
    obstacle = ros.prefixes[0] / "share/ament_index/resource_index/packages/made_ros"
    obstacle.mkdir()
    source = Source("LAUNCH", NO_GIT, "1", commit_of(clone), ("made_launch", "made_ros"))
    with pytest.raises(RealLaunchError, match="could not install what was built: "):
        install(ros, {"LAUNCH": str(clone)}, python=python, sources=(source,), requirement="")
    installed = subprocess.run([python, "-m", "pip", "list"], capture_output=True, text=True, check=True).stdout
    assert "made" not in installed


def test_another_commit_than_the_pinned_one_is_refused_unless_the_user_names_its_tag(tmp_path: Path) -> None:
    clone = repository(tmp_path / "launch", {"launch/setup.py": "raise SystemExit('it was run')"}, tag="1.0")
    url, environ = clone.as_uri(), {"LAUNCH": f"{clone.as_uri()}@1.0"}
    source = Source("LAUNCH", url, "1.0", "0" * 40, ("launch",))
    message = f"refuses tag 1.0 of {url}: it is commit {commit_of(clone)}, not {'0' * 40}; LAUNCH={url}@1.0 takes it"
    with pytest.raises(RealLaunchError, match=re.escape(message)):
        install(find(), {}, sources=(source,), requirement="")
    with pytest.raises(RealLaunchError, match="found no ROS package launch in LAUNCH: "):  # the next step
        install(find(), environ, sources=(source,), requirement="")


@pytest.fixture
def silent_server() -> Iterator[str]:
    """The address of a server that accepts connections and sends nothing."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield f"http://127.0.0.1:{server.getsockname()[1]}/launch.git"


def test_sources_that_do_not_answer_are_given_up_after_ten_seconds(
    silent_server: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert real_launch.REACH_SECONDS == 10.0
    monkeypatch.setattr(real_launch, "REACH_SECONDS", 1.0)
    sources = tuple(Source(f"SOURCE_{number}", silent_server, "1", "0" * 40, ("launch",)) for number in range(3))
    message = f"could not reach {silent_server} within 1 s; point SOURCE_0 at"
    with pytest.raises(RealLaunchError, match=re.escape(message)):
        install(find(), {}, sources=sources, requirement="")


def test_set_up_uses_the_stand_ins_if_a_source_is_unreachable_and_says_so_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    missing_source = tmp_path / "nowhere"
    monkeypatch.setattr(real_launch, "installed_packages", lambda names: {})
    line = set_up({source.variable: str(missing_source) for source in SOURCES})
    assert line.startswith(f"launch and ros2: {describe_launch()} (could not reach {missing_source}: ")
    assert line.endswith(
        "; point ROS2_INTERFACES_SOURCE at a clone that this machine reaches); `make real-launch` tries again"
    )
    assert "\n" not in line


def test_set_up_installs_nothing_if_the_stand_ins_are_chosen_and_removes_the_real_packages(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    removed: list[list[str]] = []
    monkeypatch.setattr(real_launch, "remove", removed.append)
    monkeypatch.setattr(real_launch, "installed_packages", lambda names: {"launch": "3.4.3"})
    assert set_up({"ROS2_STANDINS": "1"}).endswith(", as ROS2_STANDINS=1 asks")
    assert removed == [["launch"]]


def test_set_up_does_nothing_if_the_pinned_versions_are_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(real_launch, "installed_packages", dict)
    monkeypatch.setattr(real_launch, "install", None)
    assert set_up({}).startswith("launch and ros2: ")


def test_a_repository_without_the_package_is_refused(tmp_path: Path) -> None:
    clone = repository(tmp_path / "r", {"README": "nothing"}, tag="1.2")
    source = Source("LAUNCH_SOURCE", "unused", "1.2", commit_of(clone), ("launch",))
    with pytest.raises(RealLaunchError, match="found no ROS package launch in LAUNCH_SOURCE: "):
        install(find(), {"LAUNCH_SOURCE": str(clone)}, sources=(source,), requirement="")


def test_a_sourced_installation_is_not_changed() -> None:
    sourced = RosEnvironment("sourced", (Path("/opt/ros/sourced"),), Path("/opt/ros/sourced/rclpy"))
    with pytest.raises(RealLaunchError, match="sourced from /opt/ros/sourced: it has the real launch and ros2 already"):
        install(sourced, {})


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        (None, Location("https://example.com/x.git", "1.0", "c0de")),
        ("/clones/x", Location("/clones/x", "1.0", "c0de")),
        ("/clones/x@2.0", Location("/clones/x", "2.0", "")),
        ("git@example.com:team/x.git", Location("git@example.com:team/x.git", "1.0", "c0de")),
        ("git@example.com:team/x.git@2.0", Location("git@example.com:team/x.git", "2.0", "")),
    ],
)
def test_a_source_is_an_address_with_an_optional_tag_that_is_not_pinned(
    setting: str | None, expected: Location
) -> None:
    source = Source("X_SOURCE", "https://example.com/x.git", "1.0", "c0de", ("x",))
    assert source.location({"X_SOURCE": setting} if setting else {}) == expected


def test_every_default_source_is_pinned_to_a_commit() -> None:
    assert {"launch", "launch_ros", "ros2cli", "rosidl_runtime_py"} <= set(python_packages())
    for source in SOURCES:
        assert source.url.startswith(("https://github.com/ros2/", "https://github.com/ament/"))
        assert source.tag.count(".") == 2
        assert re.fullmatch("[0-9a-f]{40}", source.commit)


def test_help_names_the_variables(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="0"):
        main(["--help"])
    assert "ROS2_LAUNCH_SOURCE" in capsys.readouterr().out


def test_a_failure_is_one_line_and_exit_code_1(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", "")
    assert main([]) == 1
    assert capsys.readouterr().err.startswith("real-launch: git is needed to fetch the sources")


def test_the_tags_are_those_of_the_records() -> None:
    tags = {Path(source.url).stem: source.tag for source in SOURCES}
    names = {"launch": "launch", "launch_ros": "launch_ros", "launch_testing": "launch", "ros2cli": "ros2cli"}
    for folder in ("launch_cases", "launch_test_cases", "ros2_records"):
        head = (ROOT / "tests/e2e" / folder / "records.yaml").read_text().partition("\n")[0]
        versions = [
            (tags[names[name]], version) for name, version in re.findall(r"(\w+) ([\d.]+),", head) if name in names
        ]
        assert versions
        assert all(tag == version for tag, version in versions), head
