"""A cluster on one machine: a scheduler and workers, each with its own network and mount namespace.

Where namespaces cannot be made (not root, no iproute2), all of them use the loopback address.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

from autograder import course_paths

DASK = str(Path(sys.executable).with_name("dask"))
SCHEDULER, CLIENT = "scheduler", "client"
WORKERS = ("worker1", "worker2", "worker3")
PORT = 8786


def can_make_namespaces() -> bool:
    """Return whether this machine lets the tests make network namespaces."""
    if os.geteuid() != 0 or shutil.which("ip") is None:
        return False
    name = f"probe-{os.getpid()}"
    is_made = subprocess.run(["ip", "netns", "add", name], capture_output=True, check=False).returncode == 0
    if is_made:
        subprocess.run(["ip", "netns", "del", name], check=True)
    return is_made


@dataclass
class LocalCluster:
    """The machines of a cluster, by their names, and the processes that run on them.

    Attributes:
        client_folder: the client's folder, which is hidden from workers that have their own namespaces.
        has_namespaces: whether each machine has its own namespaces.
    """

    client_folder: Path
    has_namespaces: bool
    certificates: Path
    machines: Path
    running: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)

    @property
    def address(self) -> str:
        """The address of the scheduler."""
        return f"tls://10.77.0.1:{PORT}" if self.has_namespaces else f"tls://127.0.0.1:{PORT + os.getpid() % 1000}"

    def namespace(self, machine: str) -> str:
        """Return the name of a machine's network namespace."""
        return f"{machine}-{os.getpid()}"

    def start(self, machine: str) -> None:
        """Start the scheduler or a worker on its machine."""
        certificate, key = self.certificates / "cluster.pem", self.certificates / "cluster.key"
        tls = ["--tls-ca-file", certificate, "--tls-cert", certificate, "--tls-key", key]
        common = ["--preload", "autograder.grade.cluster", "--no-dashboard", *tls]
        if machine == SCHEDULER:
            host, port = self.address.removeprefix("tls://").split(":")
            command = [DASK, "scheduler", "--protocol", "tls", "--host", host, "--port", port, *common]
        else:
            command = [DASK, "worker", self.address, "--no-nanny", "--nthreads", "1", "--name", machine, *common]
        self.run(machine, [str(part) for part in command])

    def run(self, machine: str, command: list[str]) -> subprocess.Popen[bytes]:
        """Run a command on a machine, in its own session."""
        folder = self.machines / machine
        folder.mkdir(exist_ok=True)
        if self.has_namespaces:
            if machine != CLIENT:  # no other machine has submissions and results
                command = [
                    "unshare",
                    "--mount",
                    "sh",
                    "-c",
                    'mount -t tmpfs none "$0" && exec "$@"',
                    str(self.client_folder),
                    *command,
                ]
            command = ["ip", "netns", "exec", self.namespace(machine), *command]
        with (folder / "log").open("ab") as log:
            self.running[machine] = subprocess.Popen(
                command,
                cwd=self.client_folder if machine == CLIENT else folder,
                env={**os.environ, "TMPDIR": str(folder)},
                start_new_session=True,
                stdout=log,
                stderr=log,
            )
        return self.running[machine]

    def kill(self, machine: str) -> None:
        """Kill the processes of a machine and all of their children, as a power cut would."""
        process = self.running[machine]
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait(30)

    def restart_ended(self) -> None:
        """Restart the machines whose process has ended, as a service manager would."""
        for machine in (SCHEDULER, *WORKERS):
            if machine not in self.running or self.running[machine].poll() is not None:
                self.start(machine)

    def log(self, machine: str) -> str:
        """Return a machine's output so far."""
        return (self.machines / machine / "log").read_text(errors="replace")


@contextmanager
def local_cluster(folder: Path) -> Iterator[LocalCluster]:
    """Yield a cluster whose files are in a folder; nothing runs yet."""
    cluster = LocalCluster(
        folder / "client", can_make_namespaces(), folder / "cluster-certificates", folder / "machines"
    )
    cluster.client_folder.mkdir()
    cluster.machines.mkdir()
    subprocess.run(["make", "-f", course_paths.ROOT / "Makefile", cluster.certificates.name], cwd=folder, check=True)
    with ExitStack() as stack:
        if cluster.has_namespaces:
            _connect(cluster, stack)
        try:
            yield cluster
        finally:
            for machine in cluster.running:
                cluster.kill(machine)


def _connect(cluster: LocalCluster, stack: ExitStack) -> None:
    """Make the namespaces and join them by a bridge in the scheduler's. The machine's own network gets no address."""

    def ip(*arguments: str) -> None:
        subprocess.run(["ip", *arguments], check=True)

    names = [cluster.namespace(machine) for machine in (SCHEDULER, *WORKERS, CLIENT)]
    for number, name in enumerate(names, start=1):
        ip("netns", "add", name)
        stack.callback(ip, "netns", "del", name)
        ip("-n", name, "link", "set", "lo", "up")
        if number == 1:
            ip("-n", name, "link", "add", "bridge", "type", "bridge")
            ip("-n", name, "addr", "add", "10.77.0.1/24", "dev", "bridge")
            ip("-n", name, "link", "set", "bridge", "up")
        else:
            ip("-n", name, "link", "add", "eth0", "type", "veth", "peer", "name", f"to{number}", "netns", names[0])
            ip("-n", names[0], "link", "set", f"to{number}", "master", "bridge", "up")
            ip("-n", name, "addr", "add", f"10.77.0.{number}/24", "dev", "eth0")
            ip("-n", name, "link", "set", "eth0", "up")
