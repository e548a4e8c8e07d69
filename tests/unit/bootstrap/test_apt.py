"""Packages that pip does not have are installed with apt if no password is needed. Otherwise they are named.

Without a compiler, or Python's headers, the set-up ends there.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from autograder import bootstrap
from autograder.bootstrap import Interpreter, SetUpError

PY312 = Interpreter("/usr/bin/python3.12", (3, 12), "3.12.1 (main)", ".cpython-312-x86_64-linux-gnu.so")
Which = Callable[..., None]


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> Which:
    """Let only the given commands be on PATH."""

    def only(*commands: str) -> None:
        monkeypatch.setattr(bootstrap.shutil, "which", lambda name: f"/bin/{name}" if name in commands else None)

    return only


def test_apt_installs_missing_packages_as_root(installed: Which, commands: Any, tmp_path: Path) -> None:
    installed("apt-get")
    bootstrap.install_tools(["bubblewrap"], tmp_path / "tried", 0, commands)
    assert [line.rpartition("DPkg::Lock::Timeout=60 ")[2] for line in commands.ran[1:]] == [
        "update",
        "install -y --no-install-recommends bubblewrap",
    ]
    assert not any("sudo" in line for line in commands.ran)


def test_apt_is_called_through_sudo_if_sudo_needs_no_password(installed: Which, commands: Any, tmp_path: Path) -> None:
    installed("apt-get", "sudo")
    bootstrap.install_tools(["bubblewrap"], tmp_path / "tried", 1000, commands)
    assert commands.ran[0] == "env sudo -n true"
    assert commands.ran[-1].startswith("sudo -n env DEBIAN_FRONTEND=noninteractive apt-get ")


@pytest.mark.parametrize(("commands_there", "failing"), [((), ""), (("apt-get", "sudo"), "sudo -n true")])
def test_without_rights_to_install_the_command_is_printed(
    installed: Which,
    commands: Any,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    commands_there: tuple[str, ...],
    failing: str,
) -> None:
    installed(*commands_there)
    commands.failing = failing
    bootstrap.install_tools(["bubblewrap", "chromium"], tmp_path / "tried", 1000, commands)
    told = "set-up: bubblewrap, chromium is missing; to install it: sudo apt-get install bubblewrap chromium\n"
    assert capsys.readouterr().out == told
    assert not any("install" in line for line in commands.ran)


def test_a_failed_installation_is_not_tried_again(
    installed: Which, commands: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    installed("apt-get")
    commands.failing = "install -y"
    bootstrap.install_tools(["chromium"], tmp_path / "tried", 0, commands)
    assert (
        "apt-get failed; set-up continues; to install them yourself: sudo apt-get install chromium"
        in capsys.readouterr().out
    )
    commands.ran.clear()
    bootstrap.install_tools(["chromium"], tmp_path / "tried", 0, commands)
    assert not any("apt-get" in line for line in commands.ran)
    assert "chromium is missing" in capsys.readouterr().out
    bootstrap.install_tools(["bubblewrap", "chromium"], tmp_path / "tried", 0, commands)
    assert any("apt-get" in line for line in commands.ran)


@pytest.mark.promise("You need Linux on x86-64, Python 3.10 to 3.13 with its headers (python3-dev), pip, make and g++.")
@pytest.mark.parametrize(
    ("there", "with_headers", "told"),
    [
        (("g++", "bwrap"), False, r"Python\.h not found, .*: run `sudo apt-get install python3\.12-dev`, then"),
        (("bwrap",), True, r"g\+\+ not found, .*: run `sudo apt-get install g\+\+`, then"),
        ((), False, r"g\+\+ and Python\.h not found, .*: run `sudo apt-get install g\+\+ python3\.12-dev`, then"),
    ],
)
def test_without_compiler_or_headers_the_set_up_stops_with_the_command(
    installed: Which, tmp_path: Path, there: tuple[str, ...], with_headers: bool, told: str
) -> None:
    installed(*there)
    if with_headers:
        (tmp_path / "Python.h").touch()
    with pytest.raises(SetUpError, match=told):
        bootstrap.require_compiler(bootstrap.missing_packages(PY312, tmp_path, browser=False))


def test_without_bubblewrap_the_set_up_continues(installed: Which, tmp_path: Path) -> None:
    installed("g++")
    (tmp_path / "Python.h").touch()
    missing = bootstrap.missing_packages(PY312, tmp_path, browser=True)
    assert missing == ["bubblewrap", "chromium"]
    bootstrap.require_compiler(missing)
