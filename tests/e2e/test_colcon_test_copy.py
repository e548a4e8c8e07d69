"""A run of `colcon test` changes nothing that later checks read."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.building.build import build
from autograder.harness import Workspace
from autograder.probes.added_files import install_with
from autograder.probes.colcon_test import colcon_test
from autograder.ros import activate
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.launcher import ISOLATION_VARIABLE

NAME = "wheels"
MANIFEST = f"""<package format="3"><name>{NAME}</name><version>0.1.0</version><description>d</description>
<maintainer email="a@example.com">A</maintainer><license>MIT</license><test_depend>python3-pytest</test_depend>
<export><build_type>ament_python</build_type></export></package>"""
SETUP = f"""from setuptools import setup
setup(name='{NAME}', version='0.1.0', packages=['{NAME}'], extras_require={{'test': ['pytest']}},
      data_files=[('share/{NAME}', ['package.xml'])])
"""
TEST = """import os
from pathlib import Path

def test_writes_everywhere():
    home = Path(__file__).parents[3]
    for folder in home / 'src' / 'wheels', home / 'install' / 'wheels', home / 'build' / 'wheels':
        (folder / 'package.xml').write_text('changed')
        os.symlink('/etc/hostname', folder / 'leak')
"""


def _state(root: Path) -> dict[str, bytes]:
    return {str(path.relative_to(root)): path.read_bytes() for path in sorted(root.rglob("*")) if path.is_file()}


def test_a_test_that_writes_to_the_workspace_leaves_no_trace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(ISOLATION_VARIABLE, Isolation.BUBBLEWRAP.value)
    package = tmp_path / "ws" / "src" / NAME
    for path, text in {
        "package.xml": MANIFEST,
        "setup.py": SETUP,
        f"{NAME}/__init__.py": "",
        "test/test_wheels.py": TEST,
    }.items():
        (package / path).parent.mkdir(parents=True, exist_ok=True)
        (package / path).write_text(text)
    (tmp_path / "home").mkdir()
    workspace = Workspace(tmp_path / "ws", activate(), tmp_path / "home")
    build(workspace, (NAME,))
    before = _state(workspace.root)
    report = colcon_test(workspace, NAME)
    assert report.executed, report.output
    assert not report.claims.messages.get("test_writes_everywhere"), report.claims
    assert _state(workspace.root) == before
    assert [path.name for path in tmp_path.iterdir() if "tested" in path.name] == []


def test_a_link_of_the_package_is_not_followed_when_files_are_added(tmp_path: Path) -> None:
    package = tmp_path / "ws" / "src" / NAME
    (package / NAME).mkdir(parents=True)
    (package / "package.xml").write_text(MANIFEST)
    (package / "setup.py").write_text(SETUP)
    (package / NAME / "__init__.py").write_text("")
    (tmp_path / "secret").write_text("hidden")
    (package / NAME / "leak.py").symlink_to(tmp_path / "secret")
    (tmp_path / "home").mkdir()
    workspace = Workspace(tmp_path / "ws", activate(), tmp_path / "home")
    install_with(workspace, NAME, [f"{NAME}/new.py"])
    assert (workspace.root.parent / "grown" / "src" / NAME / NAME / "leak.py").is_symlink()
