"""A built workspace: its programs, their environment, and the sandbox that they get."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder import course_paths
from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.harness import Workspace
from autograder.ros import activate


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    for name in ("pkg", "msgs"):
        (tmp_path / "ws" / "install" / name / "lib" / name).mkdir(parents=True)
    (tmp_path / "ws" / "install" / "pkg" / "lib" / "pkg" / "node").write_text("")
    return Workspace(tmp_path / "ws", activate(), tmp_path / "home", domain=42)


def test_an_installed_executable_is_found(workspace: Workspace) -> None:
    assert workspace.executable("pkg", "node") == workspace.install / "pkg/lib/pkg/node"


@pytest.mark.parametrize(("package", "installed"), [("pkg", "it installs node"), ("msgs", "it installs none")])
def test_a_missing_executable_is_reported_with_the_installed_ones(
    workspace: Workspace, package: str, installed: str
) -> None:
    with pytest.raises(StudentError, match=f"The package {package} installs no program robot; {installed}") as excinfo:
        workspace.executable(package, "robot")
    assert excinfo.value.diagnosis.kind is Kind.MISSING_EXECUTABLE
    assert "console_scripts in setup.py" in excinfo.value.diagnosis.sentence


def test_a_package_that_was_not_built_is_reported_as_not_built(workspace: Workspace) -> None:
    with pytest.raises(StudentError, match="The package torn was not built, so it has no program robot: look"):
        workspace.executable("torn", "robot")


def test_programs_get_a_separate_environment(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SECRET", "of the grader")
    environment = workspace.environment()
    assert "SECRET" not in environment
    assert environment["ROS_DOMAIN_ID"] == "42"
    assert environment["AMENT_PREFIX_PATH"].startswith(f"{workspace.install}/msgs:{workspace.install}/pkg:")
    assert environment["HOME"] == str(workspace.scratch)


def test_a_node_sees_the_install_space_and_no_sources(workspace: Workspace) -> None:
    spec = workspace.sandbox()
    paths = {mount.path for mount in spec.mounts}
    assert workspace.install in paths
    assert not any((workspace.root / "src").is_relative_to(path) for path in paths)
    assert not any(course_paths.CHECKS.is_relative_to(path) for path in paths)
    assert [mount.path for mount in spec.mounts if mount.writable] == [workspace.scratch]
    assert spec.network
