"""A built workspace: its programs, their environment, and the sandbox that they get."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from autograder import layout
from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.grading.job import Job, Scope
from autograder.harness import Workspace, grader_node
from autograder.ros import activate
from autograder.sandbox import Tier


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    for name in ("pkg", "msgs"):
        (tmp_path / "ws" / "install" / name / "lib" / name).mkdir(parents=True)
    (tmp_path / "ws" / "install" / "pkg" / "lib" / "pkg" / "node").write_text("")
    return Workspace(tmp_path / "ws", activate(), tmp_path / "home", domain=42)


def test_an_installed_executable_is_found(workspace: Workspace) -> None:
    assert workspace.executable("pkg", "node") == workspace.install / "pkg/lib/pkg/node"


@pytest.mark.parametrize(("package", "found"), [("pkg", "what it installs is node"), ("msgs", "it installs none")])
def test_a_missing_executable_is_told_with_what_is_installed_instead(
    workspace: Workspace, package: str, found: str
) -> None:
    with pytest.raises(StudentError, match=f"The package {package} installs no program robot; {found}") as caught:
        workspace.executable(package, "robot")
    assert caught.value.diagnosis.kind is Kind.MISSING_EXECUTABLE
    assert "console_scripts in setup.py" in caught.value.diagnosis.sentence


def test_programs_get_an_environment_of_their_own(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
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
    assert not any(layout.CHECKS.is_relative_to(path) for path in paths)
    assert [mount.path for mount in spec.mounts if mount.writable] == [workspace.scratch]
    assert spec.network


def _peer(reliability: ReliabilityPolicy, durability: DurabilityPolicy) -> SimpleNamespace:
    return SimpleNamespace(qos_profile=QoSProfile(depth=1, reliability=reliability, durability=durability))


def test_the_grader_offers_enough_for_every_subscription() -> None:
    weak = _peer(ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE)
    strong = _peer(ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL)
    assert grader_node.offered_qos([weak]).durability == DurabilityPolicy.VOLATILE
    offered = grader_node.offered_qos([weak, strong])
    assert (offered.reliability, offered.durability) == (strong.qos_profile.reliability, strong.qos_profile.durability)


def test_the_grader_asks_for_no_more_than_every_publisher_gives() -> None:
    weak = _peer(ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE)
    strong = _peer(ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL)
    assert grader_node.requested_qos([strong]).reliability == ReliabilityPolicy.RELIABLE
    assert grader_node.requested_qos([strong, weak]).reliability == ReliabilityPolicy.BEST_EFFORT


def test_a_job_crosses_a_process_boundary_whole(tmp_path: Path) -> None:
    scope = Scope(("starts", "ten_hertz"), first_loss=True, pictures=False)
    out, scratch = tmp_path / "out", tmp_path / "scratch"
    job = Job(tmp_path / "größe 漢", "02_nodes", "Zoë", 7, out, scratch, Tier.PROCESS, scope)
    assert Job.from_json(job.to_json()) == job
