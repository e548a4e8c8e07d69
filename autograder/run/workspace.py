"""A built colcon workspace: its packages, and the sandboxes of its programs."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.ros import RosEnvironment
from autograder.ros.environment import LOGS_TO_STDOUT, WHEEL_BOOTSTRAP_VARIABLES, site_packages
from autograder.run.exchanges import ExchangeLog
from autograder.run.lockstep.stepper import HOST
from autograder.run.sandbox import Limits, Mount, Sandbox
from autograder.run.sandbox.limits import NODE
from autograder.run.sandbox.spec import INTERPRETER
from autograder.run.time_record import TimeRecord


@dataclass(frozen=True)
class Workspace:
    """A colcon workspace after `colcon build`, in its isolated layout (`install/<package>/...`)."""

    root: Path  # the workspace's folder, with `src` and `install`
    ros: RosEnvironment  # the ROS 2 installation with which it was built
    scratch: Path  # a writable folder for homes and logs, for sandboxes without their own /tmp
    domain: int = 0  # the `ROS_DOMAIN_ID` of its programs and the grader
    # The record to which the harnesses add; copies of a workspace share it.
    time_record: TimeRecord = field(default_factory=TimeRecord, compare=False)
    exchanges: ExchangeLog = field(default_factory=ExchangeLog, compare=False)  # copies share it

    @property
    def install(self) -> Path:
        """The install space."""
        return self.root / "install"

    def prefixes(self) -> tuple[Path, ...]:
        """Return the prefix of each installed package."""
        return tuple(filter(Path.is_dir, sorted(self.install.iterdir()))) if self.install.is_dir() else ()

    @contextmanager
    def private_folder(self) -> Iterator[Path]:
        """Create a temporary folder beside `scratch` and `root`. No program of the workspace can ever write to it."""
        with TemporaryDirectory(prefix="apart-", dir=self.scratch.parent) as folder:
            yield Path(folder)

    def executable(self, package: str, name: str) -> Path:
        """Return the path of an installed executable. If it does not exist, a StudentError names those that do."""
        folder = self.install / package / "lib" / package
        path = folder / name
        if path.is_file():
            return path
        if not (self.install / package).is_dir():
            sentence = f"The package {package} was not built, so it has no program {name}: look at the build first."
            raise StudentError(Diagnosis(Kind.MISSING_EXECUTABLE, sentence))
        names = sorted(entry.name for entry in folder.iterdir() if entry.is_file()) if folder.is_dir() else []
        installed = f"it installs {', '.join(names)}" if names else "it installs none"
        raise StudentError(
            Diagnosis(
                Kind.MISSING_EXECUTABLE,
                f"The package {package} installs no program {name}; {installed}. Is the name misspelt? The names are "
                "in console_scripts in setup.py, and the programs' folder is in setup.cfg.",
            )
        )

    def environment(self) -> dict[str, str]:
        """Return the environment of a program of this workspace, as if its `setup.bash` had been sourced."""
        prefixes = self.prefixes()
        libraries = [str(prefix / "lib") for prefix in prefixes]
        modules = [str(path) for path in map(site_packages, prefixes) if path.is_dir()]
        inherited = {name: os.environ[name] for name in WHEEL_BOOTSTRAP_VARIABLES if name in os.environ}
        if self.ros.kind == "sourced":
            modules += [part for part in os.environ.get("PYTHONPATH", "").split(os.pathsep) if part]
        return {
            **inherited,
            **self.ros.variables(overlays=prefixes, domain=self.domain, log_dir=self.scratch / "ros-log"),
            **LOGS_TO_STDOUT,
            "LD_LIBRARY_PATH": os.pathsep.join([*libraries, os.environ.get("LD_LIBRARY_PATH", "")]).strip(os.pathsep),
            "PYTHONPATH": os.pathsep.join(modules),
            **INTERPRETER,
            "PATH": os.pathsep.join([str(Path(sys.prefix) / "bin"), "/usr/bin", "/bin"]),
            "HOME": str(self.scratch),
            "TMPDIR": str(self.scratch),
        }

    def sandbox(self, limits: Limits = NODE) -> Sandbox:
        """Return a sandbox for a node of this workspace. It can read the install space and reach peers over DDS."""
        installed = (Mount(self.install),) if self.install.is_dir() else ()
        system = tuple(Mount(prefix) for prefix in self.ros.prefixes if self.ros.kind == "sourced")
        return Sandbox(
            workdir=self.scratch,
            mounts=(*system, *installed, Mount(self.scratch, writable=True), Mount(HOST)),
            environment=self.environment(),
            network=True,
            limits=limits,
        )
