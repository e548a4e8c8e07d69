"""Containers of an image, which buildah and bubblewrap run as root, without a container runtime and without cgroups."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

# Through these files, pip reaches a mirror or a proxy that the machine uses; see assets/image/build. The certificates
# are mounted beside the container's own, because dpkg cannot replace a file that is a mount.
CERTIFICATES = "/run/machine-certificates.pem"
MACHINE = {"/etc/pip.conf": "/etc/pip.conf", "/etc/ssl/certs/ca-certificates.crt": CERTIFICATES}
SHOWN_LINES = 60  # of the output of a failed command


@dataclass(frozen=True)
class Container:
    """A container of buildah.

    Attributes:
        name: buildah's name of the container.
    """

    name: str

    @cached_property
    def root(self) -> Path:
        """The folder at which the container's files are mounted."""
        return Path(buildah("mount", self.name).stdout.strip())

    def run(self, *arguments: str, folder: str = "") -> subprocess.CompletedProcess[str]:
        """Run a program in the container, as its user and in the network of this machine, and capture the output.

        Args:
            arguments: a program and its arguments. buildah ignores the image's entry point.
            folder: the working directory; the image's own by default.

        Returns:
            The process, with any exit status.
        """
        mounts = {source: target for source, target in MACHINE.items() if Path(source).exists()}
        machine = [word for source, target in mounts.items() for word in ("--volume", f"{source}:{target}:ro")]
        if CERTIFICATES in mounts.values():
            machine += ["--env", f"PIP_CERT={CERTIFICATES}"]
        place = ["--workingdir", folder] if folder else []
        command = ["buildah", "run", "--isolation", "chroot", *machine, *place, self.name, "--", *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def run_with_namespaces(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run a program as root where it can create namespaces. The kernel forbids them in buildah's chroot."""
        mounts = ["--bind", str(self.root), "/", "--dev-bind", "/dev", "/dev", "--bind", "/proc", "/proc"]
        variables = ["--clearenv", "--setenv", "PATH", "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"]
        command = ["bwrap", "--die-with-parent", *mounts, *variables, "--setenv", "HOME", "/root", "--", *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def copy(self, source: Path, target: str, owner: str = "root") -> None:
        """Copy a folder's content into a folder of the container."""
        buildah("copy", "--quiet", "--chown", owner, self.name, str(source), target)


@contextmanager
def container(image: str) -> Iterator[Container]:
    """Make a container of an image. Afterwards, remove it and kill its processes."""
    made = Container(buildah("from", "--pull=never", image).stdout.strip())
    try:
        yield made
    finally:
        for process in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                if (process / "root").samefile(made.root):
                    os.kill(int(process.name), signal.SIGKILL)
        buildah("rm", made.name)


def buildah(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run buildah, which must succeed."""
    done = subprocess.run(["buildah", *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, end_of(done)
    return done


def end_of(done: subprocess.CompletedProcess[str]) -> str:
    """Return the last lines that a program printed, for the message of a failed test."""
    return "\n".join((done.stdout + done.stderr).splitlines()[-SHOWN_LINES:])
