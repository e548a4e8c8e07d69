"""Diagnoses of ended programs are sentences that a student can act on."""

from __future__ import annotations

import sys

import pytest

from autograder.diagnosis import Kind
from autograder.run.lockstep.failures import (
    diagnose_crash,
    diagnose_deadlock,
    diagnose_exit,
    diagnose_no_answer,
    diagnose_output,
    diagnose_unsteppable,
    tail,
)
from autograder.run.lockstep.protocol import REASONS, Crash, Deadlock
from autograder.run.sandbox import Limits, Process


def _ended_process(code: str, **limits: float) -> Process:
    process = Process([sys.executable, "-I", "-c", code], Limits(**limits))  # type: ignore[arg-type]
    with process:
        assert process.wait(60.0)
    return process


@pytest.mark.parametrize(
    ("phase", "kind", "words"),
    [
        ("import", Kind.CRASHED_AT_IMPORT, "Your module could not be imported: KeyError: 'x'."),
        ("start", Kind.CRASHED_AT_START, "while it was being set up, before it started to spin: KeyError: 'x'."),
        ("spin", Kind.CRASHED_LATER, "Your node crashed while it was running: KeyError: 'x'."),
    ],
)
def test_a_crash_is_named_by_its_phase(phase: str, kind: Kind, words: str) -> None:
    diagnosis = diagnose_crash(Crash(phase, "KeyError", "'x'", "Traceback\n  line 3\nKeyError: 'x'"))
    assert diagnosis.kind is kind
    assert words in diagnosis.sentence
    assert "line 3" in diagnosis.detail


@pytest.mark.parametrize("kind", ["SyntaxError", "IndentationError", "TabError"])
def test_a_syntax_error_has_its_own_diagnosis(kind: str) -> None:
    diagnosis = diagnose_crash(Crash("import", kind, "expected ':' (robot.py, line 7)", "..."))
    assert diagnosis.kind is Kind.SYNTAX_ERROR
    assert "Python cannot read your file: expected ':' (robot.py, line 7). Fix that line" in diagnosis.sentence


def test_a_module_generated_by_rosidl_is_not_called_the_students_file() -> None:
    traceback = '  File "/ws/install/msgs/lib/python3/site-packages/msgs/msg/_status.py", line 72\n    x = []\n'
    diagnosis = diagnose_crash(Crash("import", "SyntaxError", "invalid syntax (_status.py, line 72)", traceback))
    assert diagnosis.kind is Kind.CRASHED_AT_IMPORT
    assert (
        "the code that rosidl generated from one of your definitions: invalid syntax (_status.py, line 72)"
        in diagnosis.sentence
    )


def test_an_exception_without_a_message_is_shown_by_its_type() -> None:
    assert "running: AssertionError. The last" in diagnose_crash(Crash("spin", "AssertionError", "", "")).sentence


def test_a_service_callback_without_a_response_is_reported() -> None:
    traceback = '  File "rclpy/service.py", line 83, in send_response\n    raise TypeError()\nTypeError\n'
    sentence = diagnose_crash(Crash("spin", "TypeError", "", traceback)).sentence
    assert sentence.startswith("A service's callback has not returned the response")


def test_a_message_field_of_another_type_is_reported() -> None:
    code = 'import os; print("robot: Assertion `PyLong_Check(field)\' failed.", flush=True); os.abort()'
    assert "a field, or the whole message, has the wrong type" in diagnose_exit(_ended_process(code)).sentence


def test_a_program_that_just_ends_gets_the_advice_to_spin() -> None:
    diagnosis = diagnose_exit(_ended_process("print('bye')"))
    assert diagnosis.kind is Kind.ENDED_EARLY
    assert "(exit status 0)" in diagnosis.sentence
    assert "rclpy.spin(node)" in diagnosis.sentence
    assert diagnosis.detail == "bye"


def test_a_program_that_a_signal_ended_is_reported_with_the_signal() -> None:
    diagnosis = diagnose_exit(_ended_process("import os; os.kill(os.getpid(), 11)"))
    assert "(signal 11)" in diagnosis.sentence


@pytest.mark.parametrize(
    ("code", "limits", "kind", "words"),
    [
        ("while True: pass", {"wall_seconds": 0.3}, Kind.TIMED_OUT, "look for a loop that never ends"),
        ("while True: print('x' * 999)", {"output": 9999}, Kind.FLOODED_OUTPUT, "throttle_duration_sec=1.0"),
        (
            "held = []\nwhile True: held.append(bytearray(b'x') * 2**20)",
            {"memory": 60 * 2**20},
            Kind.OUT_OF_MEMORY,
            "a list that only ever grows",
        ),
        (
            "import threading\nwhile True: threading.Thread(target=threading.Event().wait).start()",
            {"threads": 20},
            Kind.OUT_OF_MEMORY,
            "start them once, not in a callback",
        ),
    ],
)
def test_a_program_that_exceeds_a_limit_is_reported_with_the_limit(
    code: str, limits: dict[str, float], kind: Kind, words: str
) -> None:
    diagnosis = diagnose_exit(_ended_process(code, **limits))
    assert diagnosis.kind is kind
    assert words in diagnosis.sentence


def test_a_program_that_runs_but_no_longer_answers_is_not_reported_as_ended() -> None:
    with Process([sys.executable, "-I", "-c", "import signal; signal.pause()"], Limits()) as process:
        diagnosis = diagnose_exit(process)
    assert diagnosis.kind is Kind.STUCK
    assert "no longer answers the grader" in diagnosis.sentence


def test_a_node_that_never_spins_and_a_node_that_hangs_have_different_diagnoses() -> None:
    never_started, stuck = (
        diagnose_no_answer(Kind.NEVER_STARTED, "60 s", "a\nb"),
        diagnose_no_answer(Kind.STUCK, "30 s", ""),
    )
    assert "did not start to spin within 60 s" in never_started.sentence
    assert never_started.detail == "a\nb"
    assert "A callback of your node did not return within 30 s" in stuck.sentence


def test_a_printed_traceback_names_the_crash() -> None:
    diagnosis = diagnose_output(_ended_process("print('starting', flush=True)\nraise ValueError('no lidar')"))
    assert diagnosis is not None
    assert diagnosis.kind is Kind.CRASHED_AT_START
    assert "ValueError: no lidar" in diagnosis.sentence
    assert diagnose_output(_ended_process("print('all is well')")) is None


def test_only_the_end_of_a_long_output_is_kept() -> None:
    assert tail("\n".join(map(str, range(100))), 3) == "97\n98\n99"
    assert tail("") == ""


@pytest.mark.parametrize(
    ("reason", "words"),
    [
        ("thread", "the only thread that could run the code that takes the answer is waiting itself"),
        ("group", "the code that takes the answer is in a callback group that the waiting callback holds"),
        ("spin", "nothing spins yet, so the code that takes the answer can never run"),
    ],
)
def test_a_deadlock_is_explained(reason: str, words: str) -> None:
    diagnosis = diagnose_deadlock(Deadlock("client.call()", "/add", reason), "a\nb")
    assert diagnosis.kind is Kind.STUCK
    assert "Your node waits for ever in client.call() for an answer from /add, a deadlock: " in diagnosis.sentence
    assert words in diagnosis.sentence
    assert diagnosis.detail == "a\nb"
    unnamed = diagnose_deadlock(Deadlock("rate.sleep()", "", reason), "").sentence
    assert "in rate.sleep(), a deadlock: " in unnamed
    assert "the callback that would end the wait" in unnamed


@pytest.mark.parametrize("reason", REASONS)
def test_a_program_that_cannot_be_stepped_gets_the_reason(reason: str) -> None:
    diagnosis = diagnose_unsteppable(reason, "")
    assert diagnosis.kind is Kind.NEVER_STARTED
    assert "Your node's time cannot be stepped: it " in diagnosis.sentence
