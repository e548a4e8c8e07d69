"""What a zygote imports for `colcon test`: all that colcon, pytest with its plug-ins, the linters and ROS import."""

from __future__ import annotations

import os
import runpy
from contextlib import redirect_stderr, redirect_stdout, suppress
from importlib import import_module
from pathlib import Path

import pytest

AUTOGRADER = Path(__file__).parents[1]


class Imports:
    """Imports while pytest rewrites its plug-ins' assertions: of a plug-in without that it would warn later."""

    def pytest_configure(self) -> None:
        """Import what tests import, too."""
        self.launches = runpy.run_path(str(AUTOGRADER / "harness" / "launch_host" / "preload.py"))
        for name in ("ament_flake8.main", "ament_pep257.main"):
            with suppress(ImportError):
                import_module(name)


runpy.run_path(str(AUTOGRADER / "building" / "preload.py"))
with Path(os.devnull).open("w") as nothing, redirect_stdout(nothing), redirect_stderr(nothing):
    pytest.main(["--help", "-c", os.devnull], plugins=[imports := Imports()])
READY, warm = imports.launches["READY"], imports.launches["warm"]
