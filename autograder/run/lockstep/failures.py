"""Explains to students why their program ended or stopped, and what to change."""

from __future__ import annotations

import re

from autograder.diagnosis import Diagnosis, Kind
from autograder.run.lockstep.protocol import Crash, Deadlock
from autograder.run.lockstep.tracebacks import student_frames
from autograder.run.sandbox import ExitReason, Process

_LINES = 25  # of the end of a program's output, which a diagnosis contains
_FRAME = re.compile(r"^  File .*, in (\w+)$", re.MULTILINE)
_GENERATED = re.compile(r'/(?:msg|srv|action)/_\w{1,200}\.py", line \d')  # a generated interface module
_PHASES = {
    "import": (Kind.CRASHED_AT_IMPORT, "Your module could not be imported"),
    "start": (Kind.CRASHED_AT_START, "Your node crashed while it was being set up, before it started to spin"),
    "spin": (Kind.CRASHED_LATER, "Your node crashed while it was running"),
}

_LIMITS = {
    ExitReason.WALL_TIME: (
        Kind.TIMED_OUT,
        "Your program took too long and was stopped: look for a loop that never ends.",
    ),
    ExitReason.MEMORY: (
        Kind.OUT_OF_MEMORY,
        "Your program used more memory than a node needs and was stopped: look for a list that only ever grows.",
    ),
    ExitReason.THREADS: (
        Kind.OUT_OF_MEMORY,
        "Your program started far too many threads or processes and was stopped: start them once, not in a callback.",
    ),
    ExitReason.FILES: (
        Kind.OUT_OF_MEMORY,
        "Your program created far too many files and was stopped: write one file, and not one in each callback.",
    ),
    ExitReason.OUTPUT: (
        Kind.FLOODED_OUTPUT,
        "Your program printed endlessly and was stopped: log when something changes, "
        "or give the logger throttle_duration_sec=1.0.",
    ),
}


def diagnose_crash(crash: Crash) -> Diagnosis:
    """Return the diagnosis of a reported exception, which may be a syntax error or an unfinished exercise."""
    traceback_text = tail(student_frames(crash.traceback))
    if crash.type == "SyntaxError" and _GENERATED.search(crash.traceback):
        sentence = (
            f"Python cannot read the code that rosidl generated from one of your definitions: {crash.message}. rosidl "
            "cannot write an empty array, [], as a default: leave it out, because an array without a default is empty."
        )
        return Diagnosis(Kind.CRASHED_AT_IMPORT, sentence, traceback_text)
    if crash.type in ("SyntaxError", "IndentationError", "TabError"):
        return Diagnosis(
            Kind.SYNTAX_ERROR,
            f"Python cannot read your file: {crash.message}. Fix that line, then run the file again.",
            traceback_text,
        )
    if crash.type == "NotImplementedError":
        frames = _FRAME.findall(traceback_text)
        location = f", in {frames[-1]}" if frames else ""
        sentence = (
            f"A part of the exercise is still to be written{location}: replace the line "
            "raise NotImplementedError(...) with your code."
        )
        return Diagnosis(Kind.UNFINISHED, sentence, traceback_text)
    kind, summary = _PHASES[crash.phase]
    if crash.type == "TypeError" and "in send_response" in crash.traceback:  # rclpy gives no other reason
        sentence = "A service's callback has not returned the response: it has to return it on every path."
        return Diagnosis(kind, sentence, traceback_text)
    reason = f"{crash.type}: {crash.message}" if crash.message else crash.type
    return Diagnosis(
        kind,
        f"{summary}: {reason}. The last lines of the traceback say where.",
        traceback_text,
    )


def diagnose_exit(process: Process) -> Diagnosis:
    """Return the diagnosis of a program that ended or no longer answers, but has reported no exception."""
    detail = tail(process.output)
    if process.exit_reason in _LIMITS:
        kind, sentence = _LIMITS[process.exit_reason]
        return Diagnosis(kind, sentence, detail)
    if process.exit_reason is None:
        return Diagnosis(
            Kind.STUCK,
            "Your program is still running, but no longer answers the grader: do not replace functions of rclpy, and "
            "do not use or close file descriptors that your program did not open.",
            detail,
        )
    status = process.returncode
    if "Assertion `" in process.output:
        return Diagnosis(
            Kind.ENDED_EARLY,
            "Your program was aborted when it sent a message: a field, or the whole message, has the wrong type. "
            "The line with Assertion names the expected type.",
            detail,
        )
    ending = f"exit status {status}" if status is not None and status >= 0 else f"signal {-(status or 0)}"
    return Diagnosis(
        Kind.ENDED_EARLY,
        f"Your program ended by itself ({ending}) while its node should have kept spinning: "
        "main() has to call rclpy.spin(node), and nothing may call exit().",
        detail,
    )


def diagnose_no_answer(kind: Kind, duration: str, output: str) -> Diagnosis:
    """Return the diagnosis of a program that did not answer in time.

    Args:
        kind: `NEVER_STARTED` or `STUCK`.
        duration: the duration of the wait in words, such as "60 s".
        output: what the program printed.
    """
    if kind is Kind.NEVER_STARTED:
        sentence = (
            f"Your node did not start to spin within {duration}: look for a loop, an input() or a sleep in "
            "__init__ or in main() before rclpy.spin(node)."
        )
    else:
        sentence = (
            f"A callback of your node did not return within {duration}: a callback must return quickly. "
            "Look for a loop that waits, a time.sleep or a blocking call."
        )
    return Diagnosis(kind, sentence, tail(output))


def diagnose_too_much(output: str) -> Diagnosis:
    """Return the diagnosis of a program that has too many nodes, topics and timers for one message."""
    sentence = (
        "Your program has more nodes, topics, services or timers than can be graded: create each of them once, in "
        "__init__, and none in a loop or in a callback."
    )
    return Diagnosis(Kind.STUCK, sentence, tail(output))


UNSTEPPABLE = {  # why a program cannot be stepped, as a clause, for each of the protocol's `REASONS`
    "thread": "it uses rclpy in threads of its own",
    "clock": "it has a timer on a clock that is not the ROS clock",
    "sleep": "it sleeps in a loop instead of spinning",
}


def diagnose_unsteppable(reason: str, output: str) -> Diagnosis:
    """Return the diagnosis of a program whose time cannot be stepped."""
    sentence = (
        f"Your node's time cannot be stepped: {UNSTEPPABLE[reason]}. Let a timer of the node do the work, and "
        "rclpy.spin(node) run it."
    )
    return Diagnosis(Kind.NEVER_STARTED, sentence, tail(output))


_DEADLOCKS = {
    "thread": "the only thread that could run {it} is waiting itself. In a callback, use call_async() or "
    "send_goal_async() and a done callback, or a timer for work that repeats",
    "group": "{it} is in a callback group that the waiting callback holds, so it can never run. Use a done callback, "
    "or put the two into different callback groups",
    "spin": "nothing spins yet, so {it} can never run. Use call_async() or send_goal_async() with "
    "rclpy.spin_until_future_complete()",
}


def diagnose_deadlock(deadlock: Deadlock, output: str) -> Diagnosis:
    """Return the diagnosis of a call that will never return."""
    purpose = f" for an answer from {deadlock.name}" if deadlock.name else ""
    awaited = "the code that takes the answer" if deadlock.name else "the callback that would end the wait"
    reason = _DEADLOCKS[deadlock.reason].format(it=awaited)
    sentence = f"Your node waits for ever in {deadlock.what}{purpose}, a deadlock: {reason}."
    return Diagnosis(Kind.STUCK, sentence, tail(output))


def tail(text: str, lines: int = _LINES) -> str:
    """Return the last lines of a text."""
    return "\n".join(text.strip().splitlines()[-lines:])


def diagnose_output(process: Process) -> Diagnosis | None:
    """Return the diagnosis of a crash from the traceback that a program printed in real time, or None."""
    if "Traceback (most recent call last)" not in process.output:
        return None
    traceback_text = process.output.rpartition("Traceback (most recent call last)")[2]
    last_line = next(
        (line for line in reversed(traceback_text.strip().splitlines()) if line and not line[0].isspace()), ""
    )
    kind, _, message = last_line.partition(": ")
    return diagnose_crash(Crash("start", kind, message, tail(traceback_text)))
