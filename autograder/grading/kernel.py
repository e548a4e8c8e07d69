"""Starts a Jupyter kernel in the sandbox, by a kernel provisioner and a kernel manager."""

from __future__ import annotations

import asyncio
import signal
import sys
from pathlib import Path
from typing import Any

from jupyter_client.kernelspec import KernelSpec, KernelSpecManager
from jupyter_client.manager import AsyncKernelManager
from jupyter_client.provisioning.provisioner_base import KernelProvisionerBase

from autograder.sandbox import Process, Sandbox
from autograder.sandbox.launcher import launch


class SandboxedProvisioner(KernelProvisionerBase):
    """Starts a kernel as a process in `sandbox`, which must be set before `launch_kernel`."""

    sandbox: Sandbox | None = None
    process: Process | None = None
    started: Process | None = None  # the process, even after `wait` has reset `process`

    @property
    def has_process(self) -> bool:
        return self.process is not None

    async def poll(self) -> int | None:
        return 0 if self.process is None else self.process.returncode

    async def wait(self) -> int | None:
        if self.process is None:
            return None
        await asyncio.to_thread(self.process.wait, None)
        status, self.process = self.process.returncode, None
        return status

    async def send_signal(self, signum: int) -> None:
        if self.process is not None:
            self.process.signal(signal.Signals(signum))

    async def kill(self, restart: bool = False) -> None:
        if self.process is not None:
            self.process.kill()

    async def terminate(self, restart: bool = False) -> None:
        await self.kill(restart)

    async def cleanup(self, restart: bool = False) -> None:
        await self.kill(restart)

    async def launch_kernel(self, cmd: list[str], **kwargs: Any) -> Any:
        assert self.sandbox is not None
        self.process = self.started = launch(cmd, self.sandbox)
        return self.connection_info

    async def pre_launch(self, **kwargs: Any) -> dict[str, Any]:
        manager: Any = self.parent
        manager.write_connection_file()
        self.connection_info = manager.get_connection_info()
        return await super().pre_launch(cmd=manager.format_kernel_cmd(), **kwargs)


class _OneKernel(KernelSpecManager):
    """Returns the grader's own Python for every kernel name."""

    def get_kernel_spec(self, kernel_name: str) -> KernelSpec:
        return KernelSpec(
            argv=[sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"],
            display_name="Python 3",
            language="python",
        )


class SandboxedKernelManager(AsyncKernelManager):
    """Starts a kernel in a sandbox. It connects to it by Unix sockets in a folder, not by ports."""

    def __init__(self, sandbox: Sandbox, connections: Path) -> None:
        super().__init__(
            kernel_spec_manager=_OneKernel(),
            transport="ipc",
            connection_file=str(connections / "k.json"),
            ip=str(connections / "k"),
        )
        self._provisioner = SandboxedProvisioner(kernel_id="student", kernel_spec=self.kernel_spec, parent=self)
        self._provisioner.sandbox = sandbox
        self.provisioner = self._provisioner

    @property
    def process(self) -> Process | None:
        """The process of the kernel, or None before its start."""
        return self._provisioner.started

    def end(self) -> None:
        """Kill the kernel, even if Jupyter regards it as ended."""
        if self.process is not None:
            self.process.kill()
