"""An interface bundle: its packages, its key in the cache, and the folder that its scripts name."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.building import bundle_server
from autograder.building.interface_bundle import interface_bundle, relocate
from autograder.run.sandbox.limits import SOURCES
from autograder.run.sandbox.trees import read_tree
from autograder.submission.packages import read_packages

GROUP = "<member_of_group>rosidl_interface_packages</member_of_group>"


def package(source: Path, name: str, *depends: str, interface: bool = False) -> None:
    folder = source / name
    folder.mkdir(parents=True)
    needs = "".join(f"<depend>{other}</depend>" for other in depends)
    (folder / "package.xml").write_text(f"<package><name>{name}</name>{needs}{GROUP if interface else ''}</package>")
    if interface:
        (folder / "CMakeLists.txt").write_text("project(x)\n")


def bundled_packages(source: Path, *requested: str) -> set[str]:
    return set(interface_bundle(read_packages(source)[0], requested))


def test_the_bundle_contains_the_interfaces_that_the_requested_packages_need(tmp_path: Path) -> None:
    package(tmp_path, "robot", "robot_msgs", "rclpy")
    package(tmp_path, "robot_msgs", "base_msgs", interface=True)
    package(tmp_path, "base_msgs", interface=True)
    package(tmp_path, "other_msgs", interface=True)
    assert bundled_packages(tmp_path, "robot") == {"robot_msgs", "base_msgs"}
    assert bundled_packages(tmp_path, "base_msgs") == {"base_msgs"}
    assert bundled_packages(tmp_path, "missing") == set()


def test_interfaces_that_need_a_code_package_of_the_submission_are_not_bundled(tmp_path: Path) -> None:
    package(tmp_path, "robot_msgs", "tool", interface=True)
    package(tmp_path, "tool")
    assert bundled_packages(tmp_path, "robot_msgs") == set()


def test_a_cycle_of_dependencies_ends_the_search(tmp_path: Path) -> None:
    package(tmp_path, "one_msgs", "two_msgs", interface=True)
    package(tmp_path, "two_msgs", "one_msgs", interface=True)
    assert bundled_packages(tmp_path, "one_msgs") == {"one_msgs", "two_msgs"}


@pytest.mark.parametrize("name", ["CMakeLists.txt", "package.xml", "extra.txt"])
def test_any_change_of_content_changes_the_key(tmp_path: Path, name: str) -> None:
    package(tmp_path, "robot_msgs", interface=True)

    def current_key() -> str:
        return bundle_server.key(read_tree(tmp_path, SOURCES))

    before = current_key()
    assert current_key() == before
    path = tmp_path / "robot_msgs" / name
    path.write_text((path.read_text() if path.exists() else "") + " ")
    assert current_key() != before


def test_scripts_name_the_new_folder_and_other_files_are_unchanged(tmp_path: Path) -> None:
    share = tmp_path / "install" / "robot_msgs" / "share" / "robot_msgs"
    share.mkdir(parents=True)
    (share / "package.sh").write_text("COLCON=/old/install/robot_msgs\n")
    (share / "notes.txt").write_text("/old/install\n")
    (share / "link.sh").symlink_to("notes.txt")
    relocate(tmp_path / "install" / "robot_msgs", "/old/install", str(tmp_path / "install"))
    assert (share / "package.sh").read_text() == f"COLCON={tmp_path}/install/robot_msgs\n"
    assert (share / "notes.txt").read_text() == "/old/install\n"
