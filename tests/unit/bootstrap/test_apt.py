"""Packages that pip does not have are installed with apt if no password is needed. Otherwise they are named.

Without a compiler or Python's headers, the set-up stops.
"""

from __future__ import annotations

import shutil
import sysconfig
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from autograder.doctor import apt

DEV = f"python{sysconfig.get_python_version()}-dev"
LeaveOnPath = Callable[..., None]


@pytest.fixture
def leave_on_path(monkeypatch: pytest.MonkeyPatch) -> LeaveOnPath:
    """Return a function that leaves only the given commands on PATH."""

    def only(*commands: str) -> None:
        monkeypatch.setattr(shutil, "which", lambda name: f"/bin/{name}" if name in commands else None)

    return only


def test_apt_installs_missing_packages_as_root(leave_on_path: LeaveOnPath, commands: Any, tmp_path: Path) -> None:
    leave_on_path("apt-get")
    apt.install(["bubblewrap"], tmp_path / "tried", 0, commands)
    assert [line.rpartition("DPkg::Lock::Timeout=60 ")[2] for line in commands.ran[1:]] == [
        "update",
        "install -y --no-install-recommends bubblewrap",
    ]
    assert not any("sudo" in line for line in commands.ran)


def test_apt_is_called_through_sudo_if_sudo_needs_no_password(
    leave_on_path: LeaveOnPath, commands: Any, tmp_path: Path
) -> None:
    leave_on_path("apt-get", "sudo")
    apt.install(["bubblewrap"], tmp_path / "tried", 1000, commands)
    assert commands.ran[0] == "env sudo -n true"
    assert commands.ran[-1].startswith("sudo -n env DEBIAN_FRONTEND=noninteractive apt-get ")


@pytest.mark.parametrize(("on_path", "failing"), [((), ""), (("apt-get", "sudo"), "sudo -n true")])
def test_without_rights_to_install_the_command_is_printed(
    leave_on_path: LeaveOnPath,
    commands: Any,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    on_path: tuple[str, ...],
    failing: str,
) -> None:
    leave_on_path(*on_path)
    commands.failing = failing
    apt.install(["bubblewrap", "chromium"], tmp_path / "tried", 1000, commands)
    line = "set-up: bubblewrap, chromium is missing; to install it: sudo apt-get install bubblewrap chromium\n"
    assert capsys.readouterr().out == line
    assert not any("install" in line for line in commands.ran)


def test_a_failed_installation_is_not_tried_again(
    leave_on_path: LeaveOnPath, commands: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    leave_on_path("apt-get")
    commands.failing = "install -y"
    apt.install(["chromium"], tmp_path / "tried", 0, commands)
    assert (
        "apt-get failed; set-up continues; to install them yourself: sudo apt-get install chromium"
        in capsys.readouterr().out
    )
    commands.ran.clear()
    apt.install(["chromium"], tmp_path / "tried", 0, commands)
    assert not any("apt-get" in line for line in commands.ran)
    assert "chromium is missing" in capsys.readouterr().out
    apt.install(["bubblewrap", "chromium"], tmp_path / "tried", 0, commands)
    assert any("apt-get" in line for line in commands.ran)


@pytest.mark.promise("You need Linux on x86-64, Python 3.10 to 3.13 with its headers (python3-dev), pip, make and g++.")
@pytest.mark.parametrize(
    ("tools", "with_headers", "message"),
    [
        (("g++", "bwrap"), False, rf"Python\.h not found, .*: run `sudo apt-get install {DEV}`, then"),
        (("bwrap",), True, r"g\+\+ not found, .*: run `sudo apt-get install g\+\+`, then"),
        ((), False, rf"g\+\+ and Python\.h not found, .*: run `sudo apt-get install g\+\+ {DEV}`, then"),
    ],
)
def test_without_compiler_or_headers_the_set_up_stops_with_the_command(
    leave_on_path: LeaveOnPath, tmp_path: Path, tools: tuple[str, ...], with_headers: bool, message: str
) -> None:
    leave_on_path(*tools)
    if with_headers:
        (tmp_path / "Python.h").touch()
    with pytest.raises(SystemExit, match=message):
        apt.require_compiler(apt.missing_packages(tmp_path, browser=False))


def test_without_bubblewrap_the_set_up_continues(leave_on_path: LeaveOnPath, tmp_path: Path) -> None:
    leave_on_path("g++")
    (tmp_path / "Python.h").touch()
    missing = apt.missing_packages(tmp_path, browser=True)
    assert missing == ["bubblewrap", "chromium"]
    apt.require_compiler(missing)
