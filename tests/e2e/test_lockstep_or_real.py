"""A program that cannot be stepped runs in real time with the same verdicts, and its result says so."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from autograder.author.verification.mutants import mutants, write_mutant, write_reference
from autograder.grade.job import Job, Options
from autograder.grade.pipeline import grade_submission
from autograder.harness.auto import TIME_VARIABLE
from autograder.result.model import Result
from autograder.suite import suites
from tests.e2e import lockstep_programs as programs
from tests.e2e.sandbox_support import in_worker_sandbox

CHECKS = (
    *("starts", "subscribes_scan", "publishes_cmd_vel", "forward_when_clear", "turns_when_blocked"),
    *("only_forward_counts", "ten_hertz"),
)
PACKAGE = "my_robot_package"
NODE = f"src/{PACKAGE}/{PACKAGE}/nodes/robot_controller.py"


THREADED = """thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
        thread.start()
        thread.join()
"""


def grade(folder: Path, assignment: str = "02_nodes", checks: tuple[str, ...] = CHECKS) -> Result:
    """Grade a source tree by some of its assignment's checks."""
    return grade_submission(Job(folder, assignment, "s", 11, folder / "out", options=Options(only=checks)))


def outcomes(result: Result, checks: tuple[str, ...] = CHECKS) -> dict[str, str]:
    """Return the outcomes of the checks."""
    return {check.id: check.outcome.value for check in result.checks if check.id in checks}


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["five_hertz", *(pytest.param(name, marks=pytest.mark.nightly) for name in ("reference", "all_beams"))]
)
def test_the_verdicts_are_the_same_in_lockstep_and_in_real_time(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if name == "reference":
        write_reference((PACKAGE,), tmp_path)
    else:
        write_mutant(next(mutant for mutant in mutants("02_nodes") if mutant.id == name), (PACKAGE,), tmp_path)
    stepped = grade(tmp_path)
    monkeypatch.setenv(TIME_VARIABLE, "real")
    real = grade(tmp_path)
    assert outcomes(real) == outcomes(stepped)
    assert ("failed" in outcomes(stepped).values()) is (name != "reference")
    assert (stepped.time, stepped.time_note, stepped.held_up) == ("lockstep", "", 0.0)
    assert real.held_up > 0.0
    assert (real.time, real.time_note) == ("real", "robot_controller ran in real time, because this was requested.")


@pytest.mark.slow
@pytest.mark.nightly
def test_a_controller_with_a_wall_clock_timer_keeps_its_marks_in_real_time(tmp_path: Path) -> None:
    write_reference((PACKAGE,), tmp_path)
    text = (tmp_path / NODE).read_text()
    assert "self.create_timer(CONTROL_PERIOD, self.control_loop)" in text
    text = text.replace("self.control_loop)", "self.control_loop, clock=Clock(clock_type=ClockType.STEADY_TIME))")
    text = text.replace(
        "from rclpy.node import Node", "from rclpy.clock import Clock, ClockType\nfrom rclpy.node import Node"
    )
    (tmp_path / NODE).write_text(text)
    result = grade(tmp_path)
    assert set(outcomes(result).values()) == {"passed"}
    assert result.time == "real"
    assert result.time_note == (
        "robot_controller ran in real time, because it has a timer on a clock that is not the ROS clock."
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("assignment", "file", "checks"),
    [
        pytest.param(
            "05_parameters",
            f"{PACKAGE}/{PACKAGE}/nodes/configured_node.py",
            ("starts", "names", "overrides", "start_rate", "rate_change", "contradiction", "no_side_effects"),
            marks=pytest.mark.nightly,
        ),
        pytest.param(
            "07_best_practices",
            f"{PACKAGE}/{PACKAGE}/nodes/robust_node.py",
            ("once_a_second", "late_joiners", "unstable", "declared"),
            marks=pytest.mark.nightly,
        ),
        pytest.param(
            "09_assessment",
            "motor_guard/motor_guard/running.py",
            ("definitions", "messages_are_generated", "installs", "readings", "stamps", "average", "hysteresis"),
            marks=pytest.mark.nightly,
        ),
    ],
)
def test_a_node_that_spins_in_a_thread_keeps_its_marks_in_real_time(
    assignment: str, file: str, checks: tuple[str, ...], tmp_path: Path
) -> None:
    write_reference(suites.hidden(assignment).sources, tmp_path)
    spin_in_a_thread(tmp_path / "src" / file)
    result = grade(tmp_path, assignment, checks)
    assert outcomes(result, checks) == dict.fromkeys(checks, "passed")
    assert result.time == "real"
    assert "ran in real time, because it uses rclpy in threads of its own." in result.time_note


@pytest.mark.slow
def test_all_programs_run_in_real_time_if_one_of_them_cannot_be_stepped(tmp_path: Path) -> None:
    builds = ("build", "clearance_message", "health_message", "interface_package", "processor", "controller", "monitor")
    checks = (*builds, "sectors", "drives", "stops", "enable", "health_levels", "declared")
    assignment, package = "08_capstone", tmp_path / "src/robot_navigation_tutorial/robot_navigation_tutorial"
    write_reference(suites.hidden(assignment).sources, tmp_path)
    (package / "threaded.py").write_text((package / "running.py").read_text())
    spin_in_a_thread(package / "threaded.py")
    monitor = package / "status_monitor.py"
    monitor.write_text(monitor.read_text().replace("robot_navigation_tutorial.running", f"{package.name}.threaded"))
    result = grade(tmp_path, assignment, checks)
    assert outcomes(result, checks) == dict.fromkeys(checks, "passed")
    assert (result.time, result.time_note) == (
        "real",
        "status_monitor ran in real time, because it uses rclpy in threads of its own. "
        "Programs that run alongside it also ran in real time: navigation_controller, sensor_processor.",
    )


def spin_in_a_thread(path: Path) -> None:
    """Make a program of the reference spin in a separate thread."""
    text = path.read_text()
    assert text.count("        rclpy.spin(node)\n") == 1
    text = text.replace("        rclpy.spin(node)\n", f"        {THREADED}")
    path.write_text(text.replace("import rclpy\n", "import threading\n\nimport rclpy\n", 1))


def write_workspace(scratch: Path, text: str) -> Any:
    """Write a built workspace with one program; return it."""
    from autograder.harness import Workspace
    from autograder.ros import activate

    folder = scratch / "ws" / "install" / "pkg" / "lib" / "pkg"
    folder.mkdir(parents=True)
    (scratch / "home").mkdir()
    (folder / "node").write_text(f"#!/usr/bin/env python3\n{programs.HEAD}{text}")
    return Workspace(scratch / "ws", activate(), scratch / "home")


def run_twice(scratch: Path, text: str) -> Any:
    """Run a program twice; return the kind of time of each run, if its messages arrived, and the explanation."""
    from std_msgs.msg import String

    from autograder.harness import AutoHarness

    workspace = write_workspace(scratch, text)
    runs = []
    for _ in range(2):
        with AutoHarness(workspace, "pkg", "node", subscribes={"/said": String}) as harness:
            start = harness.seconds
            harness.run(1.0)
            runs.append([harness.time, 8 <= len(harness.messages("/said", since=start)) <= 12])
    return runs, workspace.time_record.explain()


@pytest.mark.promise(
    "runs in real time, and the result says so.",
    "| Grading takes minutes. |",
    "`AutoHarness` steps a program if possible",
)
@pytest.mark.parametrize(
    ("reason", "words"),
    [
        ("thread", "node ran in real time, because it uses rclpy in threads of its own."),
        ("sleep", "node ran in real time, because it sleeps in a loop instead of spinning."),
        ("clock", "node ran in real time, because it has a timer on a clock that is not the ROS clock."),
    ],
)
def test_a_program_that_cannot_be_stepped_is_detected_and_runs_in_real_time(reason: str, words: str) -> None:
    runs, sentence = in_worker_sandbox(run_twice, programs.UNSTEPPABLE[reason])
    assert runs == [["real", True]] * 2
    assert sentence == words


def test_a_program_that_can_be_stepped_is_stepped() -> None:
    program = "class Tick(Speaker):\n    def __init__(self):\n        super().__init__()\n"
    program += "        self.create_timer(0.1, lambda: self.say('tick'))\nspin(Tick)\n"
    assert in_worker_sandbox(run_twice, program) == [[["lockstep", True]] * 2, ""]


def time_with_idle_thread(scratch: Path) -> str:
    """Return the kind of time that is chosen for a program whose thread is idle."""
    from autograder.harness import AutoHarness

    text = "class Waits(Speaker):\n    def __init__(self):\n        super().__init__()\n"
    text += "        threading.Thread(target=threading.Semaphore(0).acquire, daemon=True).start()\nspin(Waits)\n"
    with AutoHarness(write_workspace(scratch, text), "pkg", "node") as harness:
        return harness.time


def test_a_program_with_its_own_thread_runs_in_real_time_before_the_thread_sends_anything() -> None:
    assert in_worker_sandbox(time_with_idle_thread) == "real"


def receive_late(scratch: Path) -> int:
    """Let a program publish ten messages before the grader reads them; return how many have their time of arrival."""
    import time

    from std_msgs.msg import String

    from autograder.harness import RealTimeHarness

    text = "class Tick(Speaker):\n    def __init__(self):\n        super().__init__()\n"
    text += "        self.create_timer(0.05, lambda: (self.say('tick'), print('tick', flush=True)))\nspin(Tick)\n"
    with RealTimeHarness(write_workspace(scratch, text), "pkg", "node", subscribes={"/said": String}) as harness:
        assert harness.until(lambda: bool(harness.messages("/said")), 10.0)
        start, ticks, deadline = harness.seconds, harness.output.count("tick"), time.monotonic() + 30.0
        while harness.output.count("tick") < ticks + 10 and time.monotonic() < deadline:
            time.sleep(0.01)
        end = harness.seconds
        harness.run(0.2)
        return len(harness.messages("/said", since=start, until=end))


def test_a_message_that_the_grader_reads_late_keeps_its_time_of_arrival() -> None:
    assert in_worker_sandbox(receive_late) >= 8  # one may have been read before, and one may be on its way


def step(scratch: Path, text: str) -> list[str]:
    """Step a program that cannot be stepped; return the kind and sentence of the diagnosis."""
    from autograder.exceptions import StudentError
    from autograder.harness import SteppedHarness

    try:
        with SteppedHarness(write_workspace(scratch, text), "pkg", "node"):
            return ["", ""]
    except StudentError as error:
        return [error.diagnosis.kind.value, error.diagnosis.sentence]


def test_stepping_a_program_that_cannot_be_stepped_reports_the_reason() -> None:
    kind, sentence = in_worker_sandbox(step, programs.UNSTEPPABLE["thread"])
    assert kind == "never_started"
    assert "cannot be stepped: it uses rclpy in threads of its own. Let a timer of the node do the work" in sentence
