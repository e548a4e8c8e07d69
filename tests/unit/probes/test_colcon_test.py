"""A report of `colcon test` counts only if setup.py names pytest: setup.py could have written the report itself."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.probes import colcon_test
from autograder.probes.installed import inspect_package
from autograder.probes.student_test_reports import ClaimedOutcome, Claims, Report
from autograder.ros import activate
from autograder.run.sandbox import ExitReason
from autograder.run.workspace import Workspace

NAME = "wheels"
REQUIRES = f"install/{NAME}/lib/python3.12/site-packages/{NAME}-0.1.0-py3.12.egg-info/requires.txt"
FORGED = Report(ExitReason.EXITED, 0, Claims({"test_all::test_all": ClaimedOutcome.PASSED}), 0, "")
SETUP = f"src/{NAME}/setup.py"


@pytest.mark.parametrize(
    ("files", "counts"),
    [
        ({SETUP: "open('../../build/wheels/pytest.xml', 'w').write('<testsuite/>')\nsetup(name='wheels')\n"}, False),
        ({SETUP: "setup(name='wheels', tests_require=[])\n"}, False),
        ({SETUP: "# tests_require=['pytest']\nsetup(name='wheels')\n"}, False),
        ({SETUP: "setup(", REQUIRES: "[doc]\npytest\n"}, False),
        ({SETUP: "setup(name='wheels', tests_require=['pytest>=6'])\n"}, True),
        ({SETUP: "setup(**{'name': 'wheels', 'tests_require': 'pytest'})\n"}, True),
        ({SETUP: "setup()\n", f"src/{NAME}/setup.cfg": "[options]\ntests_require =\n  pytest\n"}, True),
        ({SETUP: "setup(name='wheels')\n", REQUIRES: "setuptools\n\n[test]\npytest\n"}, True),
    ],
)
def test_a_report_counts_only_if_the_package_names_pytest(
    files: dict[str, str], counts: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for path, text in {f"src/{NAME}/package.xml": f"<package><name>{NAME}</name></package>", **files}.items():
        (tmp_path / "ws" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "ws" / path).write_text(text)
    workspace = Workspace(tmp_path / "ws", activate(), tmp_path)
    monkeypatch.setattr(colcon_test, "_colcon_test", lambda *arguments: (FORGED, True))
    assert bool(colcon_test.colcon_test(workspace, NAME).executed) is counts
    assert colcon_test.runs_pytest(workspace, inspect_package(workspace.install, NAME)) is counts
