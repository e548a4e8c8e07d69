"""A watched process is limited, measured, and ended with its block."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from autograder.run.sandbox import ExitReason, Limits, Process
from autograder.run.sandbox.limits import MIB
from autograder.run.sandbox.procfs import measure

LONG = 60.0


def _python(code: str, *arguments: str) -> list[str]:
    return [sys.executable, "-I", "-c", code, *arguments]


def _wait_until(condition: Callable[[], bool], seconds: float = LONG) -> bool:
    deadline = time.monotonic() + seconds
    pause = threading.Event()
    while not condition():
        if time.monotonic() > deadline:
            return False
        pause.wait(0.02)
    return True


def _is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def test_a_program_that_ends_by_itself_leaves_its_status_and_output() -> None:
    with Process(_python("print('hello'); raise SystemExit(3)"), Limits()) as process:
        assert process.wait(LONG)
        assert (process.exit_reason, process.returncode, process.output) == (ExitReason.EXITED, 3, "hello\n")


def test_output_of_a_program_can_be_read_at_once() -> None:
    """Text that a program has written is in the output at once, without a wait for the watcher."""
    code = "import os, sys\nfor n in range(3000):\n    print(n, flush=True); os.write(int(sys.argv[1]), b'x')"
    read_end, write_end = os.pipe()
    try:
        with Process(_python(code, str(write_end)), Limits(), pass_fds=(write_end,)) as process:
            os.close(write_end)
            number = 0
            while os.read(read_end, 1):
                assert process.output.splitlines()[number:], number
                number += 1
        assert number == 3000
    finally:
        os.close(read_end)


def test_a_running_program_has_neither_a_status_nor_an_exit_reason() -> None:
    with Process(_python("import signal; print('up', flush=True); signal.pause()"), Limits()) as process:
        assert _wait_until(lambda: process.output == "up\n")
        assert (process.exit_reason, process.returncode) == (None, None)
    assert process.exit_reason is ExitReason.KILLED
    assert process.returncode == -signal.SIGKILL


def test_a_program_cannot_read_from_the_grader_s_stdin() -> None:
    with Process(_python("input()"), Limits()) as process:
        assert process.wait(LONG)
        assert "EOFError" in process.output


def test_the_run_time_of_a_program_is_limited() -> None:
    with Process(_python("while True: pass"), Limits(wall_seconds=0.5)) as process:
        assert process.wait(LONG)
        assert process.exit_reason is ExitReason.WALL_TIME


def test_the_time_limit_of_a_forked_program_starts_when_it_enters() -> None:
    with Process(_python("import signal; signal.pause()"), Limits(wall_seconds=0.2), is_placeholder=True) as process:
        assert not process.wait(1.0)
        process.adopt(process.pid)
        assert process.wait(LONG)
        assert process.exit_reason is ExitReason.WALL_TIME


def test_output_is_limited_and_only_its_first_part_is_kept() -> None:
    with Process(_python("while True: print('x' * 999)"), Limits(output=10_000)) as process:
        assert process.wait(LONG)
        assert process.exit_reason is ExitReason.OUTPUT
        assert len(process.output) == 10_000


def test_memory_of_the_whole_tree_is_limited() -> None:
    code = """
import subprocess, sys, signal
eat = "import signal; held = bytearray(b'x') * (60 << 20); signal.pause()"
children = [subprocess.Popen([sys.executable, "-I", "-c", eat]) for _ in range(3)]
signal.pause()
"""
    with Process(_python(code), Limits(memory=150 * MIB)) as process:
        assert process.wait(LONG)
        assert process.exit_reason is ExitReason.MEMORY


def test_many_small_processes_are_limited_by_their_number_and_not_by_memory() -> None:
    code = "import os, signal\nfor _ in range(40): os.fork() or signal.pause()\nsignal.pause()"
    with Process(_python(code), Limits(memory=120 * MIB)) as process:
        assert process.wait(LONG)
        assert process.exit_reason is ExitReason.THREADS


def test_threads_of_the_whole_tree_are_limited() -> None:
    code = "import threading\nfor _ in range(60): threading.Thread(target=threading.Event().wait).start()"
    with Process(_python(code), Limits(threads=30)) as process:
        assert process.wait(LONG)
        assert process.exit_reason is ExitReason.THREADS


def test_a_program_that_ignores_sigterm_is_killed_with_its_children() -> None:
    code = """
import signal, subprocess, sys
signal.signal(signal.SIGTERM, signal.SIG_IGN)
child = subprocess.Popen([sys.executable, "-I", "-c", "import signal; signal.pause()"])
print(child.pid, flush=True)
signal.pause()
"""
    with Process(_python(code), Limits()) as process:
        assert _wait_until(lambda: process.output.endswith("\n"))
        child = int(process.output)
        process.signal(signal.SIGTERM)
        assert _is_alive(child)
    assert _wait_until(lambda: not _is_alive(process.pid) and not _is_alive(child))


def test_bytes_that_are_not_utf_8_are_replaced() -> None:
    with Process(_python(r"import os; os.write(1, b'a\xff\x00b')"), Limits()) as process:
        assert process.wait(LONG)
        assert process.output == "a\N{REPLACEMENT CHARACTER}\0b"


def test_a_grandchild_that_keeps_the_output_open_does_not_delay_the_end() -> None:
    code = """
import subprocess, sys
print(subprocess.Popen([sys.executable, "-I", "-c", "import signal; signal.pause()"]).pid, flush=True)
"""
    with Process(_python(code), Limits()) as process:
        assert process.wait(LONG)
        grandchild = int(process.output)
        assert process.exit_reason is ExitReason.EXITED
        assert _is_alive(grandchild)
    os.kill(grandchild, signal.SIGKILL)


def test_signals_after_the_end_do_nothing() -> None:
    with Process(_python("pass"), Limits()) as process:
        assert process.wait(LONG)
        process.signal(signal.SIGINT)
        process.kill()
        assert (process.exit_reason, process.returncode) == (ExitReason.EXITED, 0)


def test_a_program_has_only_the_given_environment() -> None:
    environment = {"ONLY": "this"}
    with Process(
        _python("import os; print(os.environ.get('HOME'), os.environ['ONLY'])"), Limits(), environment=environment
    ) as process:
        assert process.wait(LONG)
        assert process.output == "None this\n"


def test_measuring_finds_the_whole_tree() -> None:
    code = """
import subprocess, sys, threading, signal
child = subprocess.Popen([sys.executable, "-I", "-c", "import signal; signal.pause()"])
threading.Thread(target=threading.Event().wait, daemon=True).start()
print(child.pid, flush=True)
signal.pause()
"""
    with Process(_python(code), Limits()) as process:
        assert _wait_until(lambda: process.output.endswith("\n"))
        tree = measure(process.pid)
        assert set(tree.pids) == {process.pid, int(process.output)}
        assert tree.threads == 3
        assert tree.memory > 5 * MIB


def test_measuring_stops_at_far_too_many_processes() -> None:
    assert len(measure(os.getpid()).pids) >= 1
    assert len(measure(1, max_threads=0).pids) <= 1


def test_measuring_an_ended_process_gives_no_process() -> None:
    with Process(_python("pass"), Limits()) as process:
        assert process.wait(LONG)
    assert measure(process.pid).pids == ()


def test_a_missing_program_raises_an_error_at_once() -> None:
    with pytest.raises(FileNotFoundError):
        Process(["/no/such/program"], Limits())


def test_many_processes_at_once_are_each_watched() -> None:
    running = [Process(_python(f"print({number})"), Limits()) for number in range(12)]
    try:
        assert all(process.wait(LONG) for process in running)
        assert [process.output for process in running] == [f"{number}\n" for number in range(12)]
    finally:
        for process in running:
            process.__exit__()


@pytest.mark.parametrize(("seconds", "exit_reason"), [(0.5, ExitReason.EXITED), (LONG, ExitReason.THREADS)])
def test_a_worker_sandbox_survives_a_bomb_that_is_stopped_in_it(seconds: float, exit_reason: ExitReason) -> None:
    code = "import threading, time\nwait = threading.Event()\nfor _ in range(30):\n    "
    code += f"threading.Thread(target=wait.wait).start()\ntime.sleep({seconds})\nwait.set()"
    with Process(_python(code), Limits(threads=10, excess_measurements=8)) as process:
        assert process.wait(LONG)
        assert process.exit_reason is exit_reason
