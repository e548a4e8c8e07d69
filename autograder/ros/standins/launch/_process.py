"""A child process in its own session, whose output is read to the end, and which is never left running.

The child leads its own process group, so Ctrl-C in a terminal reaches only the launch. The launch then sends exactly
one SIGINT to the whole group, so that a shell, a debugger or a wrapper ends together with its children.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

# Time for the remaining members of a finished process's group, before they are killed.
_GROUP_EXIT_SECONDS = 2.0
# Time for output after the whole group has ended; it can only come from a process that left the group.
_DRAIN_SECONDS = 1.0
OutputCallback = Callable[[str, bytes], None]


class _PipeReader(asyncio.Protocol):
    """Passes the data of one pipe to a callback; the future `ended` is done when the pipe is closed."""

    def __init__(self, source: str, on_output: OutputCallback) -> None:
        self._source = source
        self._on_output = on_output
        self.ended: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    def data_received(self, data: bytes) -> None:
        self._on_output(self._source, data)

    def connection_lost(self, exc: Exception | None) -> None:
        if not self.ended.done():
            self.ended.set_result(None)


class _ExitProtocol(asyncio.SubprocessProtocol):
    """The future `exited` is done when the process has exited."""

    def __init__(self) -> None:
        self.exited: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    def process_exited(self) -> None:
        self.exited.set_result(None)


class ChildProcess:
    """A running child process, which `start` creates."""

    def __init__(
        self, transport: asyncio.SubprocessTransport, exited: asyncio.Future[None], outputs: dict[str, int]
    ) -> None:
        self._transport = transport
        self._outputs = outputs
        self._readers: list[tuple[asyncio.ReadTransport, _PipeReader]] = []
        self.exited = exited
        self.pid: int = transport.get_pid()

    @classmethod
    async def start(
        cls, cmd: Sequence[str], *, cwd: str | None, env: dict[str, str] | None, shell: bool, emulate_tty: bool
    ) -> ChildProcess:
        """Start `cmd`, in a shell or directly, with pipes or pseudo-terminals for its output.

        Raises OSError if it cannot be started.
        """
        loop = asyncio.get_running_loop()
        descriptors = {source: os.openpty() if emulate_tty else os.pipe() for source in ("stdout", "stderr")}
        read_ends = {source: pair[0] for source, pair in descriptors.items()}
        write_ends = {source: pair[1] for source, pair in descriptors.items()}
        options: dict[str, Any] = {
            "stdin": asyncio.subprocess.PIPE,
            **write_ends,
            "cwd": cwd,
            "env": env,
            "start_new_session": True,
        }
        try:
            if shell:
                transport, protocol = await loop.subprocess_shell(_ExitProtocol, " ".join(cmd), **options)
            else:
                transport, protocol = await loop.subprocess_exec(_ExitProtocol, *cmd, **options)
        except BaseException:
            for descriptor in read_ends.values():
                os.close(descriptor)
            raise
        finally:
            for descriptor in write_ends.values():
                os.close(descriptor)
        return cls(transport, protocol.exited, read_ends)

    async def read(self, on_output: OutputCallback) -> None:
        """Call `on_output` with 'stdout' or 'stderr' and the bytes from there, as they come."""
        loop = asyncio.get_running_loop()
        for source in tuple(self._outputs):
            pipe = os.fdopen(self._outputs.pop(source), "rb", 0)
            protocol = partial(_PipeReader, source, on_output)
            self._readers.append(await loop.connect_read_pipe(protocol, pipe))

    @property
    def returncode(self) -> int | None:
        """The exit code, negative for a signal, or None while the process runs."""
        return self._transport.get_returncode()

    def send_signal(self, number: int) -> bool:
        """Send a signal to the process and its children; return whether it was still running."""
        return self.returncode is None and self._signal_group(number)

    async def finish(self) -> int:
        """Wait for the exit, end the remaining members of the group, and return the exit code."""
        await self.exited
        await self._end_group()
        await asyncio.wait([reader.ended for _, reader in self._readers], timeout=_DRAIN_SECONDS)
        self._close()
        code = self.returncode
        assert code is not None
        return code

    async def kill(self) -> None:
        """Kill the process and its children."""
        self._signal_group(signal.SIGKILL)
        await self.exited
        self._close()

    def _close(self) -> None:
        """Close the pipes."""
        for transport, _ in self._readers:
            transport.close()
        while self._outputs:
            os.close(self._outputs.popitem()[1])
        self._transport.close()

    async def _end_group(self) -> None:
        if not self._signal_group(signal.SIGTERM):
            return
        loop = asyncio.get_running_loop()
        deadline = loop.time() + _GROUP_EXIT_SECONDS
        while _has_living_members(self.pid) and loop.time() < deadline:
            await asyncio.sleep(0.05)
        self._signal_group(signal.SIGKILL)

    def _signal_group(self, number: int) -> bool:
        """Send a signal to the group; return whether the group has any member.

        The kernel does not reuse the number of a group that has members, and it assigns new numbers in sequence.
        """
        try:
            os.killpg(self.pid, number)
        except ProcessLookupError:
            return False
        except PermissionError:
            # A member runs as another user, and cannot be signalled.
            return True
        return True


def _has_living_members(group: int) -> bool:
    """Return whether a process group has a member that is not a zombie."""
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            # The name in parentheses may contain any character. State, parent and group follow.
            state, _, process_group = stat.read_text().rpartition(")")[2].split()[:3]
            if int(process_group) == group and state != "Z":
                return True
    return False
