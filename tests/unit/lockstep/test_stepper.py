"""The grader's end of the pipes against programs that send false messages, hang or send nothing."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.run import patience
from autograder.run.lockstep import Stepper, UnsteppableError, stepper
from autograder.run.lockstep.stepper import Timeout
from autograder.run.sandbox import ExitReason, Sandbox, launcher

START = "import os, sys, signal\nread, write = int(sys.argv[1]), int(sys.argv[2])\n"
DONE = (
    '{"event": "done", "sent": [{"/cmd_vel": 3}], "lost": [], "changed": false, "wake": null, "due": null, '
    '"notes": []}\\n'
)
Open = Callable[[str], Stepper]


@pytest.fixture
def host(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Open]:
    """Open a stepper on a program that replaces the runner and sends forged messages."""
    monkeypatch.setenv(launcher.ISOLATION_VARIABLE, "process")
    monkeypatch.setattr(stepper, "START_TIMEOUT", Timeout(30.0, 10.0))
    with ExitStack() as stack:

        def open_stepper(code: str) -> Stepper:
            program = tmp_path / "forger.py"
            program.write_text(START + code)
            monkeypatch.setattr(stepper, "HOST", program)
            return stack.enter_context(Stepper(Sandbox(tmp_path), tmp_path / "node"))

        yield open_stepper


def _kind(action: Callable[[], object]) -> Kind:
    with pytest.raises(StudentError) as excinfo:
        action()
    return excinfo.value.diagnosis.kind


def test_a_host_that_answers_is_stepped(host: Open) -> None:
    answers = rf"""
os.write(write, b'{{"event": "ready"}}\n')
os.read(read, 999)
os.write(write, b'{DONE}')
signal.pause()
"""
    program = host(answers)
    program.wait_ready()
    assert program.step([(10**9, {"/scan": 1})]).sent == ({"/cmd_vel": 3},)


@pytest.mark.parametrize("sent", ["[]", "[{}, {}]"], ids=["no event", "more events than it was given"])
def test_a_reply_to_another_number_of_events_is_refused(host: Open, sent: str) -> None:
    program = host(f"os.write(write, b'{DONE}'.replace(b'[{{\"/cmd_vel\": 3}}]', b'{sent}'))\nsignal.pause()")
    assert _kind(lambda: program.step([(1, {})])) is Kind.STUCK


def test_a_program_that_delays_each_step_a_little_uses_up_the_time_budget(
    host: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(patience._Budget, "answer_seconds", 0.0)
    monkeypatch.setattr(patience._Budget, "deadline", time.monotonic() + 600.0)
    monkeypatch.setattr(patience, "MAX_ANSWER_SECONDS", 1.0)
    program = host(rf"""
import time
while os.read(read, 999):
    time.sleep(0.3)
    os.write(write, b'{DONE}')
""")

    def steps() -> None:
        for _ in range(20):
            program.step([(10**9, {})])

    assert _kind(steps) is Kind.TIMED_OUT


def test_a_line_that_arrives_in_pieces_is_read_completely(host: Open) -> None:
    program = host(r"""
for byte in b'{"event": "ready"}\n':
    os.write(write, bytes([byte]))
signal.pause()
""")
    program.wait_ready()


def test_a_program_that_ends_before_it_is_ready_is_reported_as_ended_early(host: Open) -> None:
    assert _kind(host("raise SystemExit(4)").wait_ready) is Kind.ENDED_EARLY


def test_a_program_that_never_becomes_ready_is_reported_as_never_started(
    host: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stepper, "START_TIMEOUT", Timeout(0.5, 10.0))
    assert _kind(host("signal.pause()").wait_ready) is Kind.NEVER_STARTED


def test_a_step_without_a_reply_is_reported_as_stuck(host: Open, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stepper, "STEP_TIMEOUT", Timeout(0.5, 10.0))
    program = host('os.write(write, b\'{"event": "ready"}\\n\')\nsignal.pause()')
    program.wait_ready()
    assert _kind(lambda: program.step([(1, {})])) is Kind.STUCK


def test_a_program_that_computes_without_end_is_not_waited_for(host: Open, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stepper, "START_TIMEOUT", Timeout(600.0, 0.2))
    with pytest.raises(StudentError, match="did not start to spin within 0 s of computing"):
        host("while True: pass").wait_ready()


TRICKLE = """
import time
end = time.monotonic() + 10.0
while time.monotonic() < end:
    os.write(write, b" ")
    {pause}
"""
SLEEP, COMPUTE = "time.sleep(0.02)", "used = time.process_time()\n    while time.process_time() < used + 0.02: pass"


def test_bytes_that_arrive_one_by_one_do_not_extend_the_wait_for_an_answer(
    host: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stepper, "START_TIMEOUT", Timeout(0.7, 10.0))
    assert _kind(host(TRICKLE.format(pause=SLEEP)).wait_ready) is Kind.NEVER_STARTED


def test_bytes_that_arrive_one_by_one_do_not_hide_endless_computing(
    host: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stepper, "START_TIMEOUT", Timeout(600.0, 0.2))
    with pytest.raises(StudentError, match="did not start to spin within 0 s of computing"):
        host(TRICKLE.format(pause=COMPUTE)).wait_ready()


def test_bytes_that_arrive_one_by_one_use_up_the_time_budget(host: Open, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patience._Budget, "answer_seconds", 0.0)
    monkeypatch.setattr(patience._Budget, "deadline", time.monotonic() + 600.0)
    monkeypatch.setattr(patience, "MAX_ANSWER_SECONDS", 0.5)
    assert _kind(host(TRICKLE.format(pause=SLEEP)).wait_ready) is Kind.TIMED_OUT


def test_a_program_that_takes_its_own_bytes_back_does_not_block_the_grader(
    host: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The student's code can open the grader's end of the pipe, too, and read faster than the grader."""
    monkeypatch.setattr(stepper, "START_TIMEOUT", Timeout(0.5, 10.0))
    program = host("signal.alarm(5)  # ends the program\nsignal.pause()")
    monkeypatch.setattr(program._selector, "select", lambda timeout: ["a byte that is gone"])
    assert _kind(program.wait_ready) is Kind.NEVER_STARTED


@pytest.mark.parametrize(
    "forged",
    [
        "b'100 points\\n'",
        "b'[' * 5000 + b'\\n'",
        'b\'{"event": "passed", "score": 100}\\n\'',
        "b'\\x80\\x04\\x95\\n'",
    ],
)
def test_a_forged_line_is_refused_as_an_event(host: Open, forged: str) -> None:
    assert _kind(host(f"os.write(write, {forged})\nraise SystemExit(0)").wait_ready) is Kind.ENDED_EARLY


def test_a_program_with_too_many_topics_for_one_line_is_reported(host: Open) -> None:
    with pytest.raises(StudentError, match="more nodes, topics, services or timers"):
        host("os.write(write, b'x' * 60_000)\nos.write(write, b'x' * 60_000)").wait_ready()


def test_a_crash_event_becomes_the_diagnosis_of_a_crash(host: Open) -> None:
    event = '{"event": "crash", "phase": "import", "type": "NameError", "message": "x", "traceback": "T"}'
    program = host(f"os.write(write, {event.encode()!r} + b'\\n')")
    assert _kind(program.wait_ready) is Kind.CRASHED_AT_IMPORT


def test_a_program_that_cannot_be_stepped_raises_its_own_error(host: Open) -> None:
    with pytest.raises(UnsteppableError) as excinfo:
        host(r"""os.write(write, b'{"event": "unsteppable", "reason": "clock"}\n')""").wait_ready()
    assert excinfo.value.reason == "clock"


def test_a_deadlock_event_becomes_the_diagnosis_stuck(host: Open) -> None:
    event = '{"event": "deadlock", "what": "client.call()", "name": "/add", "reason": "group"}'
    assert _kind(host(f"os.write(write, {event.encode()!r} + b'\\n')").wait_ready) is Kind.STUCK


def test_a_program_that_never_reads_does_not_block_the_grader(host: Open, monkeypatch: pytest.MonkeyPatch) -> None:
    program = host(rf"""
os.write(write, b'{{"event": "ready"}}\n')
while True:
    os.write(write, b'{DONE}' * 100)
""")
    program.wait_ready()

    def step_until_the_pipe_is_full() -> None:
        for step in range(10_000):
            program.step([(step, {"/scan": step})])

    assert _kind(step_until_the_pipe_is_full) is Kind.STUCK


def test_the_collected_part_of_a_line_without_end_is_bounded(host: Open) -> None:
    assert _kind(host("while True: os.write(write, b'x' * 4096)").wait_ready) is Kind.STUCK


def test_the_program_is_killed_when_the_block_ends(host: Open, tmp_path: Path) -> None:
    first = host("signal.pause()")
    with Stepper(Sandbox(tmp_path), tmp_path / "node") as program:
        assert program.process.exit_reason is None
    assert program.process.exit_reason is ExitReason.KILLED
    assert first.process.exit_reason is None
