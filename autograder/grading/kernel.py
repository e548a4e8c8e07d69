"""A Jupyter kernel in the sandbox."""

from __future__ import annotations

import sys
from pathlib import Path

from jupyter_client.manager import AsyncKernelManager

from autograder.sandbox import Sandbox
from autograder.sandbox.launcher import launch


class SandboxedKernel(AsyncKernelManager):
    """A kernel of the grader's own Python, started in a sandbox; Jupyter connects to it and does not start it.

    They meet by Unix sockets in a folder, not by ports.

    Args:
        sandbox: where it runs.
        connections: the folder, which the sandbox can write to.

    Attributes:
        process: the kernel's.
    """

    def __init__(self, sandbox: Sandbox, connections: Path) -> None:
        super().__init__(transport="ipc", connection_file=str(connections / "k.json"), ip=str(connections / "k"))
        self.write_connection_file()
        self.process = launch([sys.executable, "-m", "ipykernel_launcher", "-f", self.connection_file], sandbox)

    @property
    def has_kernel(self) -> bool:
        return True

    async def _async_is_alive(self) -> bool:  # which clients ask
        return self.process.ending is None

    is_alive = _async_is_alive

    async def shutdown_kernel(self, now: bool = False, restart: bool = False) -> None:  # type: ignore[override]
        self.process.kill()
