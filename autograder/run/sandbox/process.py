"""A watched process: its output is limited, its tree is measured while it runs, and no part of it survives."""

from __future__ import annotations

import math
import os
import selectors
import signal
import subprocess
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from enum import Enum
from pathlib import Path

from autograder.exceptions import GraderError
from autograder.run.sandbox.cgroup import ControlGroup
from autograder.run.sandbox.limits import Limits
from autograder.run.sandbox.procfs import Tree, children, cpu_seconds, measure, name

_TICK = 0.1  # s between two checks of the clock while the process prints nothing
_MEASURE = 0.25  # s between two measurements of the tree
_REPORT_BYTES = 4096  # maximum bytes of bubblewrap's report, which usually has a few hundred
_EXIT_KEY = b'"exit-code"'  # the report contains this if the command was run
_MANY_PROCESSES = 8  # if it takes at least this many processes to fill the memory, their number is the cause


class ExitReason(str, Enum):
    """Why a process ended."""

    EXITED = "exited"
    KILLED = "killed"
    WALL_TIME = "wall_time"
    MEMORY = "memory"
    THREADS = "threads"
    OUTPUT = "output"
    FILES = "files"


class Process:
    """A started command, watched by a separate thread until it ends.

    Use it as a context manager: leaving the block kills the remaining processes.

    Args:
        command: the command to run.
        limits: the resource limits of its tree.
        environment: its environment variables; those of this process if not given.
        pass_fds: descriptors that it inherits, besides its standard streams.
        cwd: its working folder; that of this process if not given.
        contained: whether the end of the outermost process ends the whole tree, as in a pid namespace.
        group: a control group that the command enters. It is closed after the command's end, before the block is left.
        writable: folders, by their paths in the sandbox, on whose file systems it may create `Limits.files` files.
        stdin: its standard input.
        is_placeholder: whether the command stands in for a program that is adopted later. Only then does the time
            start.
        status: a descriptor from which bubblewrap's report is read, and which is closed at the end. The report
            contains the exit status of the command, unless the sandbox could not be made.

    Raises:
        GraderError: in `wait`, `exit_reason` and `returncode`, if the sandbox could not be made. The student's
            code did not run, so this is not the student's failure.
    """

    def __init__(
        self,
        command: list[str],
        limits: Limits,
        *,
        environment: Mapping[str, str] | None = None,
        pass_fds: tuple[int, ...] = (),
        cwd: Path | None = None,
        contained: bool = False,
        group: ControlGroup | None = None,
        writable: tuple[Path, ...] = (),
        stdin: int = subprocess.DEVNULL,
        is_placeholder: bool = False,
        status: int | None = None,
    ) -> None:
        self._group = group
        self._status = status
        self._is_made = True  # until bubblewrap reports otherwise
        self._contained = contained
        self._writable = writable
        self._limits = limits
        self._output = bytearray()
        self._exit_reason: ExitReason | None = None
        self._lock = threading.Lock()
        self._adopted_pids: tuple[int, ...] = ()
        self._start_time = math.inf if is_placeholder else time.monotonic()
        self._popen = subprocess.Popen(
            command,
            stdin=stdin,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=None if environment is None else dict(environment),
            pass_fds=pass_fds,
            cwd=cwd,
            start_new_session=True,
        )
        assert self._popen.stdout is not None
        os.set_blocking(self._popen.stdout.fileno(), False)
        self._ended = threading.Event()
        self._watcher = threading.Thread(target=self._watch, name=f"watch-{self._popen.pid}", daemon=True)
        self._watcher.start()

    @property
    def pid(self) -> int:
        """The process id of the outermost process."""
        return self._popen.pid

    @property
    def output(self) -> str:
        """The output so far, at most `Limits.output` bytes. Bytes that are not UTF-8 are replaced."""
        return self.output_from(0).decode("utf-8", errors="replace")

    def output_from(self, start: int) -> bytes:
        """Return the output so far, without the first `start` bytes."""
        self._read()  # the watcher may not have read the pipe yet
        with self._lock:
            return bytes(self._output[start:])

    @property
    def exit_reason(self) -> ExitReason | None:
        """Why it ended, or None while it runs."""
        return self._exit_reason if self._has_ended() else None

    @property
    def returncode(self) -> int | None:
        """The exit status; negative for a signal. None while it runs."""
        return self._popen.returncode if self._has_ended() else None

    def wait(self, timeout: float | None) -> bool:
        """Wait until it has ended, for at most `timeout` seconds if that is not None. Return whether it has ended."""
        self._ended.wait(timeout)
        return self._has_ended()

    def _has_ended(self) -> bool:
        if not self._ended.is_set():
            return False
        if not self._is_made:
            raise GraderError(f"The sandbox could not be made: {self.output.strip()}")
        return True

    def cpu_seconds(self) -> float:
        """Return the processor time that its current processes have used."""
        return cpu_seconds(self._measure().pids)

    def adopt(self, pid: int) -> None:
        """Also watch a process that has joined the sandbox from outside. Its wall time starts now."""
        self._adopted_pids = (pid,)
        self._start_time = time.monotonic()

    def innermost(self) -> int:
        """Return the process id of the student's own process below the sandbox's helpers."""
        if self._adopted_pids:
            return self._adopted_pids[0]
        pid = self.pid
        while name(pid) == "bwrap" and (child_pids := children(pid)):
            pid = child_pids[0]
        return pid

    def signal(self, number: signal.Signals) -> None:
        """Send a signal to the student's own process. Do nothing if it has ended."""
        if not self._ended.is_set():
            with suppress(ProcessLookupError):
                os.kill(self.innermost(), number)

    def kill(self) -> None:
        """End the whole tree now."""
        self._end(ExitReason.KILLED)
        self._ended.wait(10.0)

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()
        self._watcher.join(10.0)

    def _measure(self) -> Tree:
        return measure(self._popen.pid, *self._adopted_pids, max_threads=self._limits.threads)

    def _files(self) -> int:
        """Return the number of files on the file systems that it can write to, or 0 if it has ended."""
        root, count = f"/proc/{self.innermost()}/root", 0
        for folder in self._writable:
            with suppress(OSError):
                statistics = os.statvfs(f"{root}{folder}")
                count += statistics.f_files - statistics.f_ffree
        return count

    def _end(self, reason: ExitReason) -> None:
        if self._exit_reason is None and self._popen.poll() is None:
            self._exit_reason = reason
        pids = self._measure().pids
        # Children are killed first, because they cannot be found without their parent, unless they end with it.
        for pid in pids if self._contained else reversed(pids):
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._popen.pid, signal.SIGKILL)

    def _watch(self) -> None:
        assert self._popen.stdout is not None
        last_measurement, min_file_count, excess_count = 0.0, math.inf, 0
        with selectors.DefaultSelector() as selector:
            selector.register(self._popen.stdout, selectors.EVENT_READ)
            open_stream = True
            while self._popen.poll() is None:
                if open_stream:
                    if selector.select(_TICK):
                        open_stream = self._read()
                else:
                    with suppress(subprocess.TimeoutExpired):
                        self._popen.wait(_TICK)
                now = time.monotonic()
                if now - self._start_time > self._limits.wall_seconds:
                    self._end(ExitReason.WALL_TIME)
                if now - last_measurement > _MEASURE:
                    last_measurement = now
                    tree = self._measure()
                    is_excess = tree.threads > self._limits.threads or tree.memory > self._limits.memory
                    excess_count = excess_count + 1 if is_excess else 0
                    if excess_count >= self._limits.excess_measurements and tree.threads > self._limits.threads:
                        self._end(ExitReason.THREADS)
                    elif excess_count >= self._limits.excess_measurements:
                        is_many = tree.largest < self._limits.memory / _MANY_PROCESSES
                        self._end(ExitReason.THREADS if is_many else ExitReason.MEMORY)
                    elif self._is_out_of_memory():
                        self._end(ExitReason.MEMORY)
                    elif (file_count := self._files()) > min_file_count + self._limits.files:
                        self._end(ExitReason.FILES)
                    else:
                        min_file_count = min(min_file_count, file_count)
            # Read the last output. Only the available bytes are read, because a grandchild may keep the pipe open.
            while open_stream and selector.select(0):
                open_stream = self._read()
        with self._lock:
            self._popen.stdout.close()
        self._popen.wait()
        self._exit_reason = self._exit_reason or (ExitReason.MEMORY if self._is_out_of_memory() else ExitReason.EXITED)
        if self._status is not None:
            report = os.read(self._status, _REPORT_BYTES)
            os.close(self._status)
            # bubblewrap exits with status 1 if it fails. A negative status means a signal, as from the OOM killer.
            self._is_made = (
                self._exit_reason is not ExitReason.EXITED or self._popen.returncode <= 0 or _EXIT_KEY in report
            )
        self._ended.set()
        if self._group is not None:
            self._group.close()

    def _is_out_of_memory(self) -> bool:
        return self._group is not None and self._group.is_out_of_memory()

    def _read(self) -> bool:
        """Read all available bytes of the pipe. Return whether more may follow."""
        assert self._popen.stdout is not None
        with self._lock:
            if self._popen.stdout.closed:
                return False
            try:
                chunk = os.read(self._popen.stdout.fileno(), 65536)
            except BlockingIOError:
                return True
            free_space = self._limits.output - len(self._output)
            self._output += chunk[: max(free_space, 0)]
        if len(chunk) > free_space:
            self._end(ExitReason.OUTPUT)
            return self._popen.poll() is None
        return bool(chunk)
