"""If a build may fail, each package gets its own result from colcon, whatever happens to the other packages."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from autograder.building import colcon
from autograder.building.build import build_workspace
from autograder.diagnosis import OK, Kind
from autograder.exceptions import StudentError
from autograder.ros import activate
from autograder.run.sandbox.limits import BUILD
from autograder.run.workspace import Workspace
from autograder.submission.exercise_stubs import CODE_STUB

MANIFEST = """<package format="3">
  <name>{name}</name><version>0.1.0</version><description>A package</description>
  <maintainer email="a@example.com">A</maintainer><license>Apache-2.0</license>
  <export><build_type>ament_python</build_type></export>
</package>
"""
SETUP = """from setuptools import setup
setup(name='{name}', version='0.1.0', packages=['{name}'], data_files=[
    ('share/ament_index/resource_index/packages', ['resource/{name}']), ('share/{name}', ['package.xml'])])
"""


MESSAGE_MANIFEST = """<package format="3">
  <name>words</name><version>0.1.0</version><description>A package</description>
  <maintainer email="a@example.com">A</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend><member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""


def write_messages(folder: Path, script: str = "") -> None:
    """Write a package that installs its package.xml and runs `script`, with the install folder as `sys.argv[1]`."""
    folder.mkdir(parents=True)
    python = os.path.realpath("/usr/bin/python3")
    run = f"{python} ${{CMAKE_CURRENT_SOURCE_DIR}}/script.py ${{CMAKE_INSTALL_PREFIX}}"
    (folder / "package.xml").write_text(MESSAGE_MANIFEST)
    (folder / "script.py").write_text(script)
    (folder / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.8)\nproject(words NONE)\ninstall(FILES package.xml DESTINATION share)\n"
        f'install(CODE "execute_process(COMMAND {run})")\n'
    )


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    """A workspace with the packages `good` and `bad`; `bad` lacks its marker, `good` has no setup.cfg."""
    for name in ("good", "bad"):
        folder = tmp_path / "ws" / "src" / name
        for part, text in (("package.xml", MANIFEST), ("setup.py", SETUP), (f"{name}/__init__.py", "")):
            (folder / part).parent.mkdir(parents=True, exist_ok=True)
            (folder / part).write_text(text.format(name=name))
    marker = tmp_path / "ws/src/good/resource/good"
    marker.parent.mkdir()
    marker.touch()
    home = tmp_path / "home"
    home.mkdir()
    return Workspace(tmp_path / "ws", activate(), home)


def test_a_failed_package_does_not_stop_the_build_of_other_packages(workspace: Workspace) -> None:
    outcome = build_workspace(workspace, ("bad", "good", "missing"), may_fail=True)
    assert outcome.diagnoses["good"] is OK
    assert (workspace.install / "good/share/good/package.xml").is_file()
    assert outcome.diagnosis is outcome.diagnoses["bad"]
    assert outcome.diagnosis.kind is Kind.BUILD_FAILED
    assert "can't copy 'resource/bad'" in outcome.diagnosis.sentence
    assert outcome.diagnoses["missing"].kind is Kind.MISSING_PACKAGE
    assert not outcome.build.ok
    assert outcome.build.packages == ("bad", "good")


def test_packages_that_build_are_built_by_one_run_of_colcon(workspace: Workspace) -> None:
    marker = workspace.root / "src/bad/resource/bad"
    marker.parent.mkdir()
    marker.touch()
    outcome = build_workspace(workspace, ("bad", "good"), may_fail=True)
    assert (outcome.build.ok, outcome.build.log, outcome.diagnosis) == (True, "", OK)
    assert all((workspace.install / name / "share" / name / "package.xml").is_file() for name in ("bad", "good"))


def test_each_package_is_built_separately_after_a_build_of_all_failed(workspace: Workspace) -> None:
    outcome = build_workspace(workspace, ("bad", "good"), may_fail=True)
    assert [diagnosis is OK for diagnosis in outcome.diagnoses.values()] == [False, True]
    assert (workspace.install / "good/share/good/package.xml").is_file()


def test_a_link_that_a_failed_build_left_ends_the_grading(workspace: Workspace) -> None:
    code = "import os\nos.makedirs('../../install', exist_ok=True)\nos.symlink('/etc', '../../install/stray')\n"
    (workspace.root / "src/bad/setup.py").write_text(f"{code}raise SystemExit('broken')\n")
    with pytest.raises(StudentError, match="leads out of the install space"):
        build_workspace(workspace, ("bad",), may_fail=True)


def test_a_build_that_a_limit_ended_is_not_repeated(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(colcon, "BUILD", replace(BUILD, wall_seconds=3.0))
    (workspace.root / "src/bad/setup.py").write_text("import time\ntime.sleep(1000)\n")
    with pytest.raises(StudentError, match=r"colcon build was stopped \(wall time\)"):
        build_workspace(workspace, ("bad", "good"), may_fail=True)


def test_a_missing_file_ends_the_grading_unless_the_build_may_fail(workspace: Workspace) -> None:
    with pytest.raises(StudentError, match="is incomplete"):
        build_workspace(workspace, ("good",))


def test_a_folder_in_which_colcon_sees_no_package_is_not_built(workspace: Workspace) -> None:
    folder = workspace.root / "src" / "good"
    (folder / "package.xml").write_text("<package><name>good</name></package>")
    (folder / "setup.py").write_text("raise SystemExit('not yet')\n")
    outcome = build_workspace(workspace, ("good",), may_fail=True)
    assert (outcome.build.ok, outcome.diagnosis.kind) == (False, Kind.BUILD_FAILED)
    assert "colcon does not find the package" in outcome.diagnosis.sentence


def test_the_quoted_error_belongs_to_the_package_that_failed(workspace: Workspace) -> None:
    folder = workspace.root / "src" / "good"
    (folder / "package.xml").write_text("<package><name></name></package>")
    (folder / "setup.py").write_text("raise NotImplementedError('not yet')\n")
    sentence = build_workspace(workspace, ("bad",), may_fail=True).diagnosis.sentence
    assert "The first error: error: can't copy 'resource/bad'" in sentence


@pytest.mark.parametrize("may_fail", [True, False])
def test_a_stub_is_reported_as_still_to_be_written(workspace: Workspace, may_fail: bool) -> None:
    (workspace.root / "src/bad/setup.py").write_text(CODE_STUB)
    try:
        diagnosis = build_workspace(workspace, ("bad",), may_fail=may_fail).diagnosis
    except StudentError as error:
        diagnosis = error.diagnosis
    assert diagnosis.kind is Kind.UNFINISHED
    assert diagnosis.sentence.startswith("src/bad/setup.py is still to be written")


TRAPS = """import os
home = os.environ['HOME']
for name in ('bundle', 'bundle-sources'):
    if not os.path.lexists(f'{home}/{name}'):
        os.symlink(home, f'{home}/{name}')
for folder, _, names in os.walk(home + '/cmake-overlay'):
    for name in names:
        os.unlink(f'{folder}/{name}')
        os.mkfifo(f'{folder}/{name}')
raise SystemExit('broken')
"""


def test_a_build_uses_no_folder_that_an_earlier_build_could_write_to(workspace: Workspace) -> None:
    (workspace.root / "src/bad/setup.py").write_text(TRAPS)
    outcome = build_workspace(workspace, ("bad", "good"), may_fail=True)
    assert (outcome.diagnoses["bad"].kind, outcome.diagnoses["good"]) == (Kind.BUILD_FAILED, OK)
    assert (workspace.scratch / "bundle").is_symlink()
    assert not list(workspace.scratch.rglob("*.cmake"))


def test_nothing_is_installed_through_a_link_that_a_failed_build_left(
    workspace: Workspace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "out").mkdir()
    code = "import os, shutil\nshutil.rmtree('../../install', ignore_errors=True)\n"
    code += "os.symlink('../out', '../../install')\nraise SystemExit('broken')\n"
    (workspace.root / "src/bad/setup.py").write_text(code)
    write_messages(workspace.root / "src" / "words")
    with pytest.raises(StudentError, match="install, which leads out of the install space"):
        build_workspace(workspace, ("bad", "words"), may_fail=True)
    assert not (tmp_path / "out" / "words").exists()
