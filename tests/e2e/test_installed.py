"""Installed files are checked before they are copied or cached: their apparent size, their number and their types."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from autograder.building.build import build
from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.harness import Workspace
from autograder.ros import activate
from autograder.run.sandbox.limits import MIB

MANIFEST = """<package format="3"><name>{name}</name><version>0.0.1</version><description>x</description>
<maintainer email="a@b.c">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
{group}<export><build_type>ament_cmake</build_type></export></package>"""
GROUP = "<member_of_group>rosidl_interface_packages</member_of_group>"
CMAKE = """cmake_minimum_required(VERSION 3.8)
project({name} NONE)
install(FILES package.xml DESTINATION share)
install(CODE "execute_process(COMMAND {python} ${{CMAKE_CURRENT_SOURCE_DIR}}/fill.py ${{CMAKE_INSTALL_PREFIX}})")
"""
FORBIDDEN = {
    "sparse files": (
        "import sys\nfor n in range(50): open(f'{sys.argv[1]}/{n}', 'w').truncate(60 << 20)",
        "files of more than 64 MiB in all, including holes",
    ),
    "a FIFO": ("import os, sys\nos.mkfifo(f'{sys.argv[1]}/pipe')", "pipe, which is a FIFO"),
    "a socket": (
        "import os, socket, sys\nos.chdir(sys.argv[1])\nsocket.socket(socket.AF_UNIX).bind('door')",
        "door, which is a socket",
    ),
    "many names": (
        "import sys\nfor n in range(6000): open(f'{sys.argv[1]}/{n}', 'w').close()",
        "more than 5000 files and folders",
    ),
    "a link": ("import os, sys\nos.symlink('/etc', f'{sys.argv[1]}/etc')", "etc, which leads out of the install space"),
}


@pytest.mark.parametrize(("case", "kind"), [*((case, "messages") for case in FORBIDDEN), ("sparse files", "program")])
def test_forbidden_installed_files_fail_the_build_with_a_sentence_and_are_not_copied(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, case: str, kind: str
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    code, sentence = FORBIDDEN[case]
    package = tmp_path / "ws" / "src" / "filler"
    package.mkdir(parents=True)
    (package / "package.xml").write_text(MANIFEST.format(name="filler", group=GROUP if kind == "messages" else ""))
    (package / "CMakeLists.txt").write_text(CMAKE.format(name="filler", python=os.path.realpath("/usr/bin/python3")))
    (package / "fill.py").write_text(code)
    (tmp_path / "home").mkdir()
    with pytest.raises(StudentError) as excinfo:
        build(Workspace(tmp_path / "ws", activate(), tmp_path / "home"), ("filler",))
    assert excinfo.value.diagnosis.kind is Kind.BUILD_FAILED
    assert sentence in excinfo.value.diagnosis.sentence
    assert "setup.py and CMakeLists.txt must install only plain files" in excinfo.value.diagnosis.sentence
    assert not any((tmp_path / "cache").rglob("install"))
    copied = sum(path.lstat().st_blocks * 512 for path in tmp_path.rglob("*"))
    assert copied < 8 * MIB
