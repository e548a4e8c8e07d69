"""`make real-launch` against local git repositories that stand for the sources."""

from __future__ import annotations

import re
import subprocess
import sysconfig
import venv
from pathlib import Path

import pytest

from autograder.layout import ROOT
from autograder.ros import RosEnvironment, find
from autograder.ros.real_launch import SOURCES, RealLaunchError, Source, install, main

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


def python_package(name: str, content: str) -> dict[str, str]:
    return {
        f"{name}/package.xml": MANIFEST.format(name=name, kind="ament_python"),
        f"{name}/setup.py": SETUP.format(name=name),
        f"{name}/resource/{name}": "",
        f"{name}/{name}/__init__.py": content,
    }


@pytest.fixture
def machine(tmp_path: Path) -> tuple[RosEnvironment, str]:
    """A virtual environment of its own that sees this one's packages, and ROS with its prefix in front."""
    prefix = tmp_path / "venv"
    venv.create(prefix, symlinks=True)
    python = str(prefix / "bin" / "python")
    packages = next(prefix.glob("lib/python*/site-packages"))
    (packages / "course.pth").write_text(sysconfig.get_path("purelib"))
    ros = find()
    return RosEnvironment("wheels", (prefix, *ros.prefixes), ros.rclpy), python


@pytest.mark.promise("`make real-launch` installs the real ones")
@pytest.mark.slow
def test_packages_are_installed_from_the_places_that_the_variables_name(
    tmp_path: Path, machine: tuple[RosEnvironment, str]
) -> None:
    ros, python = machine
    interfaces = {
        "made_interfaces/package.xml": MANIFEST.format(name="made_interfaces", kind="ament_cmake"),
        "made_interfaces/CMakeLists.txt": CMAKE,
    }
    launch = repository(tmp_path / "launch", python_package("made_launch", "VERSION = 'tagged'"), tag="9.9")
    (launch / "made_launch" / "made_launch" / "__init__.py").write_text("VERSION = 'not committed'")
    sources = (
        Source("INTERFACES", "https://example.invalid/i.git", "1", ("made_interfaces",), built=True),
        Source("LAUNCH", "https://example.invalid/l.git", "1", ("made_launch",)),
    )
    environ = {"INTERFACES": str(repository(tmp_path / "interfaces", interfaces)), "LAUNCH": f"{launch}@9.9"}
    names = install(ros, environ, python=python, sources=sources, requirements=())
    assert names == ["made_interfaces", "made_launch"]
    prefix = ros.prefixes[0]
    assert (prefix / "share/made_interfaces/package.xml").is_file()
    assert (prefix / "share/ament_index/resource_index/packages/made_launch").is_file()
    code = "import made_launch; print(made_launch.VERSION)"
    found = subprocess.run([python, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout == "tagged\n"


def test_a_source_that_cannot_be_cloned_names_the_variable_that_helps(tmp_path: Path) -> None:
    source = Source("LAUNCH_SOURCE", str(tmp_path / "nowhere"), "1.2", ("launch",))
    with pytest.raises(RealLaunchError, match=r"(?s)could not clone .*nowhere at 1.2 .*point LAUNCH_SOURCE at a local"):
        install(find(), {}, sources=(source,), requirements=())


def test_a_repository_without_the_package_is_refused(tmp_path: Path) -> None:
    place = repository(tmp_path / "r", {"README": "nothing"})
    source = Source("LAUNCH_SOURCE", "unused", "1.2", ("launch",))
    with pytest.raises(RealLaunchError, match="LAUNCH_SOURCE: launch is no ROS package"):
        install(find(), {"LAUNCH_SOURCE": str(place)}, sources=(source,), requirements=())


def test_a_sourced_installation_is_left_alone() -> None:
    sourced = RosEnvironment("sourced", (Path("/opt/ros/jazzy"),), Path("/opt/ros/jazzy/rclpy"))
    with pytest.raises(RealLaunchError, match="sourced from /opt/ros/jazzy: it has the real launch and ros2 already"):
        install(sourced, {})


@pytest.mark.parametrize(
    ("given", "place"),
    [
        (None, ("https://example.com/x.git", "1.0")),
        ("/clones/x", ("/clones/x", "")),
        ("/clones/x@2.0", ("/clones/x", "2.0")),
        ("git@example.com:team/x.git", ("git@example.com:team/x.git", "")),
        ("git@example.com:team/x.git@2.0", ("git@example.com:team/x.git", "2.0")),
    ],
)
def test_a_source_is_an_address_with_an_optional_tag(given: str | None, place: tuple[str, str]) -> None:
    source = Source("X_SOURCE", "https://example.com/x.git", "1.0", ("x",))
    assert source.place({"X_SOURCE": given} if given else {}) == place


def test_every_default_source_is_pinned_to_a_release() -> None:
    assert {"launch", "launch_ros", "ros2cli", "composition_interfaces"} <= {p for s in SOURCES for p in s.packages}
    for source in SOURCES:
        assert source.url.startswith(("https://github.com/ros2/", "https://github.com/ament/"))
        assert source.tag.count(".") == 2


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
