"""Fixtures and hooks of all tests: activates ROS, gives each test its own ROS domain, and makes results for reports."""

from __future__ import annotations

import hashlib
import itertools
import os
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import hypothesis
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from xdist.remote import Producer
from xdist.scheduler import LoadScopeScheduling

from autograder.diagnosis import Diagnosis, Kind
from autograder.result.model import Artifact, Build, CheckResult, Result, Status
from autograder.ros import activate
from autograder.ros.distribution import DISTRIBUTION
from autograder.ros.domains import Domain
from autograder.ros.environment import LOGS_TO_STDOUT
from autograder.run.sandbox.launcher import restore_sigint
from autograder.suite import Check, Outcome, Visibility

# Each run uses the same examples, because a test that fails at random cannot be a gate. `make fuzz` tries others.
# Slowness on a busy machine is not a failure.
_PATIENT = hypothesis.settings(deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow])
hypothesis.settings.register_profile("course", _PATIENT, derandomize=True)
hypothesis.settings.register_profile("fuzz", _PATIENT, derandomize=False)
hypothesis.settings.register_profile("thousand", _PATIENT, derandomize=False, max_examples=1000)
hypothesis.settings.load_profile("course")

# ROS is activated before any test module imports rclpy. Fixtures that outlive a test use the worker's own domain.
_WORKER_DOMAIN = Domain()
# Each test gets the next domain, because a participant may still be shutting down in the previous one.
_NEXT = itertools.count(_WORKER_DOMAIN.number)
activate(domain=_WORKER_DOMAIN.number)
os.environ.update(LOGS_TO_STDOUT)  # the same as for students' programs in the grader and in notebooks
restore_sigint()  # programs end on Ctrl-C even if the tests run as a background job


_CHAPTER = re.compile(r"\b[0-9]{2}_[a-z_]+")
# Tests in the files of `_SEPARATE` are long and share no fixtures, so each may run on any worker. The slowest tests,
# those of `_FIRST`, run first, so that all workers end at about the same time.
_NOTEBOOKS, _VERIFICATION = "tests/notebooks/test_chapters.py", "tests/e2e/test_mutants.py"
_JUPYTERLAB = "tests/browser/test_solve_in_jupyterlab.py"
_SEPARATE = (_NOTEBOOKS, _VERIFICATION, "tests/e2e/test_attacks.py", "tests/e2e/test_seeds.py")
_FIRST = (_NOTEBOOKS, "tests/e2e/test_nbgrader.py", _JUPYTERLAB, _VERIFICATION, "tests/e2e", "tests/browser")


class ByFile(LoadScopeScheduling):
    """Runs the tests of a file, or of a chapter in it, on one worker, which creates their shared fixtures once."""

    def _split_scope(self, nodeid: str) -> str:
        file, _, test = nodeid.partition("::")
        chapter = _CHAPTER.search(test)
        if file in _SEPARATE:
            return nodeid
        return f"{file} {chapter[0]}" if chapter else file


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> ByFile:
    return ByFile(config, log)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run the slowest files first."""

    def rank(item: pytest.Item) -> int:
        return next((rank for rank, start in enumerate(_FIRST) if item.nodeid.startswith(start)), len(_FIRST))

    items.sort(key=rank)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--fuzz-seconds", type=float, default=0.0, help="seconds for which each test marked `fuzz` is repeated"
    )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Repeat a test marked `fuzz` with other examples until its time is over."""
    end = time.monotonic() + item.config.getoption("--fuzz-seconds")
    yield
    while item.get_closest_marker("fuzz") and time.monotonic() < end:
        item.runtest()


@pytest.fixture(autouse=True)
def ros_domain(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """Give the test and its child processes a separate ROS domain; return its number."""
    with Domain(next(_NEXT)) as domain:
        monkeypatch.setenv("ROS_DOMAIN_ID", str(domain.number))
        yield domain.number


@pytest.fixture
def entered_tmp_path(tmp_path: Path) -> Path:
    """A temporary folder that other users can enter, because root's sandboxes run as other users."""
    for folder in (tmp_path, *(parent for parent in tmp_path.parents if parent.name.startswith(("pytest-", "popen-")))):
        folder.chmod(0o711)
    return tmp_path


MakeCheck = Callable[..., Check]
MakeResult = Callable[..., Result]


def _check(id: str, title: str, points: float, group: str, **fields: Any) -> Check:
    contract: dict[str, Any] = {"visibility": Visibility.HIDDEN, "hints": (), "doc": None}
    return Check(id=id, title=title, points=points, group=group, **(contract | fields))


STARTS = _check("starts", "The node starts and is called robot_controller.", 1, "graph")
LISTENS = _check("listens", "The node subscribes to /scan as a best-effort lidar publishes it.", 2, "graph")
TURNS = _check(
    "turns",
    "The robot turns when something stands within 1 m in front of it.",
    4,
    "reaction",
    hints=("Where is 0 rad in a scan?", "Compare the smallest forward range with 1.0."),
    doc=f"{DISTRIBUTION.docs}/p/sensor_msgs/",
)
STOPS = _check("stops", "The robot stops when the scan goes stale.", 2, "safety", needs=("turns",))
LATE = _check("late", "The robot starts in time.", 1, "safety")


@pytest.fixture
def make_check() -> MakeCheck:
    """Return a function that makes a check from an id, a title, points and a group."""
    return _check


@pytest.fixture(scope="session")
def make_result() -> MakeResult:
    """Return a function that makes the result of a flawed submission. Keyword arguments replace fields."""

    def make(student: str = "alice", **fields: Any) -> Result:
        base: dict[str, Any] = {
            "assignment": "02_nodes",
            "student": student,
            "submission_sha256": hashlib.sha256(student.encode("utf-8", "backslashreplace")).hexdigest(),
            "suite_version": "5ca1ab1e0000",
            "seed": 7,
            "isolation": "bubblewrap",
            "checks": (
                CheckResult.of(STARTS, Outcome.PASSED, seconds=0.41),
                CheckResult.of(LISTENS, Outcome.PASSED, seconds=0.2),
                CheckResult.of(TURNS, Outcome.FAILED, "it kept driving: 0.08 m from the north wall", fraction=0.25),
                CheckResult.of(STOPS, Outcome.NOT_CHECKED, "not checked: the robot does not turn yet"),
                CheckResult.of(LATE, Outcome.FAILED, "it starts after 3 s"),
            ),
            "max_score": 10.0,
            "started": "2026-05-04T09:00:00+00:00",
            "seconds": 12.5,
            "build": Build(ok=True, seconds=1.3, packages=("my_robot_package",)),
        }
        return Result(**(base | fields))

    return make


@pytest.fixture(scope="session")
def broken_result(make_result: MakeResult) -> Result:
    """The result of a submission that did not build."""
    return make_result(
        "bob",
        checks=tuple(CheckResult.of(check, Outcome.NOT_CHECKED, "the build failed") for check in (STARTS, TURNS)),
        diagnosis=Diagnosis(Kind.BUILD_FAILED, "The package does not build: setup.py line 3.", "SyntaxError: oops"),
        build=Build(ok=False, seconds=0.9, packages=("my_robot_package",), log="Failed <<< my_robot_package"),
    )


@pytest.fixture
def ungraded_result(make_result: MakeResult) -> Result:
    """The result of a submission on which the grader failed."""
    return make_result("carol", checks=(), status=Status.NOT_GRADED)


@pytest.fixture(scope="session")
def track() -> Callable[..., Artifact]:
    """Return a function that draws a picture of a robot's track into a folder and returns its record."""

    def draw(folder: Path, *, check: str = "turns", name: str = "turns.png") -> Artifact:
        figure = Figure(figsize=(6, 4), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots()
        axes.plot([0, 5, 5, 0, 0], [0, 0, 4, 4, 0], color="0.2", linewidth=3)
        axes.plot([0.6, 2.0, 3.2, 4.1, 4.9], [0.7, 1.1, 2.2, 3.1, 3.9], color="tab:blue")
        axes.plot([4.9], [3.9], marker="x", color="tab:red", markersize=12, markeredgewidth=3)
        axes.set(xlabel="x in m", ylabel="y in m", aspect="equal")
        folder.mkdir(parents=True, exist_ok=True)
        figure.savefig(folder / name, dpi=110)
        caption = "The robot's track: it touches the north wall at t = 12.4 s."
        return Artifact(name, "track", hashlib.sha256((folder / name).read_bytes()).hexdigest(), check, caption)

    return draw
