"""Copies a built workspace instead of building one whose sources differ only in files that colcon copies.

The verification grades thousands of versions of the reference, and building each would take longer than grading it.
"""

from __future__ import annotations

import shutil
from pathlib import Path

from autograder.building.build import BuildOutcome
from autograder.building.interface_bundle import relocate
from autograder.diagnosis import OK
from autograder.result.model import Build
from autograder.run.workspace import Workspace


def copy_prebuilt(built: Path, workspace: Workspace, packages: tuple[str, ...]) -> BuildOutcome:
    """Copy the folders `install` and `build` of a built workspace, and update them with the changed files of `src`.

    An installed file with the same name and text as a file in `built`/src is regarded as a copy of that file. If
    `built` has no install space, the workspace gets none, which is sufficient for checks that only read sources.
    """
    for part in ("install", "build"):
        if (built / part).is_dir():
            shutil.copytree(built / part, workspace.root / part, symlinks=True)
    for prefix in workspace.prefixes():
        relocate(prefix, str(built / "install"), str(workspace.install))
    source = workspace.root / "src"
    for path in (path for path in source.rglob("*") if path.is_file()):
        new, old_path = path.read_bytes(), built / "src" / path.relative_to(source)
        if old_path.is_file() and new != (old := old_path.read_bytes()):
            for copy in workspace.root.rglob(f"[ib][nu]*/**/{path.name}"):
                if copy.read_bytes() == old:
                    copy.write_bytes(new)
                    for bytecode in copy.parent.glob(f"__pycache__/{path.stem}.*"):
                        bytecode.unlink()
    return BuildOutcome(Build(True, 0.0, packages), dict.fromkeys(packages, OK))
