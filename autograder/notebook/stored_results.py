"""Stores the result of a check, which can be reused while everything that it depends on is unchanged.

A result depends on the student's files in `src`, on every file that the checks read (`autograder.suite.fingerprint`),
and on the environment: Python, ROS 2 with all installed packages, a worker's environment variables, and the isolation
level. It depends on the cells of the chapter's notebook, but not on their outputs.
"""

from __future__ import annotations

import hashlib
import json
import os
import site
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from autograder import course_paths
from autograder.building.interfaces import Cache
from autograder.building.interfaces.prefix import identity
from autograder.result.model import structure, write_json
from autograder.ros import find
from autograder.ros.environment import LOGS_TO_STDOUT, path_with_scripts, without_wheel_bootstrap
from autograder.ros.launch_packages import describe_launch
from autograder.run.sandbox import best_isolation
from autograder.run.sandbox.worker_sandbox import passed_variables
from autograder.suite import fingerprint

CACHE = "checks"  # the name of the cache in which results are stored
MAX_FILES = 100  # how many files are kept; there is one for each chapter of a workspace
# Variables that differ between a kernel and a terminal. The programs of a workspace get their own values.
_IGNORED = frozenset({"ROS_DOMAIN_ID", "ROS_LOG_DIR", "PYTHONDONTWRITEBYTECODE", *LOGS_TO_STDOUT})


@dataclass(frozen=True)
class Inputs:
    """The inputs of a result at one moment.

    Attributes:
        digest: a digest of all inputs.
        stamp: a digest of when each file was last modified. It differs even if a file was changed and changed back.
    """

    digest: str
    stamp: str


@dataclass(frozen=True)
class StoredResult:
    """A stored result.

    Attributes:
        digest: the digest of its inputs; empty if they changed during the run.
        created_at: when it was created, in ISO 8601.
        reads: additional files of the course that the checks read.
        reply: the worker's reply.
    """

    digest: str
    created_at: str
    reads: tuple[str, ...]
    reply: dict[str, Any]

    @property
    def since(self) -> str:
        """The time of day at which the result was created, with the date unless that was today."""
        creation_time = datetime.fromisoformat(self.created_at)
        return (
            f"{creation_time:%H:%M}"
            if creation_time.date() == datetime.now().date()
            else f"{creation_time:%d %B, %H:%M}"
        )


def current_inputs(assignment: str, source: Path, reads: Iterable[str] = ()) -> Inputs | None:
    """Return the current inputs of a check, or None if files are being changed or one is a link.

    Args:
        assignment: the chapter.
        source: the folder `src` of a workspace.
        reads: additional files of the course that the checks read, as paths relative to the course.
    """
    digest, stamp = hashlib.sha256(), hashlib.sha256()
    digest.update(json.dumps(_environment(), sort_keys=True, default=str).encode())
    try:
        notebook = course_paths.source_notebook(assignment)
        digest.update(_notebook_content(notebook))
        read = (path for path in fingerprint.files(assignment, reads) if path != notebook)
        for path in (*read, *sorted(Path(__file__).parent.glob("*.py")), *_source_files(source)):
            data = b"" if path.is_dir() else path.read_bytes()
            name = f"{path}\0{bool(path.stat().st_mode & 0o100)}\0{len(data)}\0".encode("utf-8", "surrogateescape")
            digest.update(name + data)
            stamp.update(name + _file_stamp(path))
    except OSError:
        return None
    return Inputs(digest.hexdigest(), stamp.hexdigest())


def load(workspace: Path, assignment: str, part: str) -> StoredResult | None:
    """Return the stored result of a chapter or a part of it, or None if it is missing or unreadable."""
    with suppress(OSError, ValueError, TypeError, LookupError, AttributeError):
        stored_result: StoredResult = structure(
            StoredResult, json.loads(_result_file(workspace, assignment).read_bytes())[part]
        )
        return stored_result
    return None


def store(workspace: Path, assignment: str, part: str, result: StoredResult) -> None:
    """Store a result in place of the previous one. If the disk is full, store nothing."""
    file, other_parts = _result_file(workspace, assignment), {}
    with suppress(OSError, ValueError):
        other_parts = json.loads(file.read_bytes())
    with suppress(OSError):
        write_json(file, {**(other_parts if isinstance(other_parts, dict) else {}), part: asdict(result)})
        oldest_first = sorted(file.parent.glob("*.json"), key=lambda path: path.stat().st_mtime)
        for path in oldest_first[:-MAX_FILES]:
            path.unlink(missing_ok=True)


def stamp_of(paths: Iterable[Path]) -> str:
    """Return a digest of when files, and the files in folders, were last modified. Unreadable ones are skipped."""
    digest = hashlib.sha256()
    for top in paths:
        for path in (top,) if top.is_file() else sorted(top.rglob("*")):
            with suppress(OSError):
                digest.update(str(path).encode("utf-8", "surrogateescape") + _file_stamp(path))
    return digest.hexdigest()


def _result_file(workspace: Path, assignment: str) -> Path:
    name = hashlib.sha256(f"{workspace.resolve()}\0{assignment}".encode("utf-8", "surrogateescape")).hexdigest()[:32]
    return Cache.default(CACHE).root / f"{name}.json"


def _source_files(source: Path) -> Iterator[Path]:
    """Yield the folders and files that a check copies, sorted.

    Raises OSError if there are none, or if there is a link, whose target may change.
    """
    os.scandir(source).close()
    for folder, folders, names in os.walk(source):
        ignored_names = course_paths.NOT_COPIED(folder, [*folders, *names])
        folders[:] = sorted(set(folders) - ignored_names)
        for path in (Path(folder, name) for name in (*folders, *sorted(set(names) - ignored_names))):
            if path.is_symlink():
                raise OSError(f"{path} is a link")
            yield path


def _notebook_content(notebook: Path) -> bytes:
    """Return the relevant content of a notebook, or all its bytes if the notebook is only partly written."""
    data = notebook.read_bytes()
    try:
        content = json.loads(data)
        cells = [
            [cell["cell_type"], "".join(cell["source"]), cell["metadata"].get("course")] for cell in content["cells"]
        ]
        return json.dumps([cells, content["metadata"].get("course")], sort_keys=True).encode()
    except (ValueError, LookupError, TypeError, AttributeError):
        return data


def _file_stamp(path: Path) -> bytes:
    status = path.stat()
    return f"{status.st_ino} {status.st_size} {status.st_mtime_ns} {status.st_ctime_ns}\n".encode()


def _environment() -> Mapping[str, Any]:
    ros = find()
    installed_packages = {name for folder in _site_packages() for name in _installation_stamps(folder)}
    own_variables = without_wheel_bootstrap(os.environ)
    variables = {**ros.variables(log_dir=Path("/")), **own_variables, "PATH": path_with_scripts()}
    relevant_variables = {name: value for name, value in passed_variables(variables).items() if name not in _IGNORED}
    return {
        **identity(ros),
        "installed": sorted(installed_packages),
        "launch": describe_launch(),
        "system": os.uname()[::2],
        "isolation": best_isolation().value,
        "variables": relevant_variables,
    }


def _site_packages() -> list[Path]:
    on_path = [path for path in sys.path if path.endswith(("site-packages", "dist-packages"))]
    return [Path(path) for path in {*on_path, *site.getsitepackages()} if Path(path).is_dir()]


def _installation_stamps(folder: Path) -> Iterator[str]:
    """Yield each installed package with the time of its installation, because reading versions takes too long."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.endswith((".dist-info", ".egg-info", ".pth")):
                yield f"{entry.path} {entry.stat().st_mtime_ns}"
