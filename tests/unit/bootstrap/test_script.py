"""The script itself, run as the Makefile runs it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from autograder import bootstrap
from autograder.bootstrap import Interpreter
from autograder.ros.distribution import DISTRIBUTION

ROOT = Path(__file__).parents[3]


def test_the_running_interpreter_is_the_one_under_the_virtual_environment() -> None:
    interpreter = Interpreter.running()
    assert not Path(interpreter.executable).is_relative_to(sys.prefix)
    code = "import sys, sysconfig; print(sys.prefix == sys.base_prefix, sysconfig.get_config_var('EXT_SUFFIX'))"
    completed = subprocess.run([interpreter.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert completed.stdout.split() == ["True", interpreter.suffix]


def test_an_activated_environment_is_set_up_by_the_same_interpreter_as_before() -> None:
    code = "from autograder.bootstrap import Interpreter; print(Interpreter.running())"
    commands = [Interpreter.running().executable, sys.executable, f"{sys.prefix}/bin/python3"]
    printed = {
        subprocess.run([command, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60).stdout
        for command in commands
    }
    assert printed == {f"{Interpreter.running()}\n"}


def script(root: Path, *arguments: str, **environ: str) -> subprocess.CompletedProcess[str]:
    """Run a clone's bootstrap as the Makefile does."""
    command = [Interpreter.running().executable, "-I", str(root / "autograder/bootstrap.py"), *arguments]
    environ = {"PATH": "/usr/bin:/bin", **environ}
    return subprocess.run(command, env=environ, capture_output=True, text=True, timeout=120)


@pytest.fixture
def script_clone(clone: Path) -> Path:
    """A clone with the bootstrap script itself, and a lock that pip rejects at once."""
    for name in ("bootstrap.py", "doctor/apt.py", "ros/distribution.json"):
        (clone / "autograder" / name).parent.mkdir(exist_ok=True)
        (clone / "autograder" / name).write_bytes((ROOT / "autograder" / name).read_bytes())
    for name in ("requirements.lock", "requirements-dev.lock"):
        (clone / name).write_text("unpinned\n")
    return clone


def test_the_script_gives_the_reason_for_a_failure_in_a_sentence(script_clone: Path) -> None:
    completed = script(script_clone, ROS_DISTRO="iron", AMENT_PREFIX_PATH="/opt/ros/iron")
    assert (completed.returncode, completed.stdout) == (1, "")
    reason = f"the sourced ROS distribution is iron, but the course needs {DISTRIBUTION.title}"
    assert completed.stderr.startswith(f"set-up: {reason}")
    assert completed.stderr.count("\n") == 1


@pytest.mark.slow
def test_the_script_shows_the_output_of_a_failed_pip_and_writes_no_stamp(script_clone: Path) -> None:
    completed = script(script_clone)
    assert completed.returncode == 1
    assert "set-up: installing the pinned packages of requirements.lock" in completed.stdout
    assert "unpinned" in completed.stderr
    assert "set-up: pip could not install requirements.lock" in completed.stderr
    assert not (script_clone / ".venv" / bootstrap.STAMP).exists()


def test_without_pythons_headers_the_script_ends_before_it_makes_anything(script_clone: Path, tmp_path: Path) -> None:
    for tool in ("g++", "bwrap"):  # and no apt-get
        (tmp_path / tool).touch(mode=0o755)
    apt = script_clone / "autograder/doctor/apt.py"
    before, headers, after = apt.read_text().partition('sysconfig.get_path("include")')
    assert headers
    apt.write_text(f"{before}{str(tmp_path)!r}{after}")
    completed = script(script_clone, PATH=str(tmp_path))
    assert completed.returncode == 1
    assert "set-up: Python.h not found" in completed.stderr
    assert "-dev`, then the same command again.\n" in completed.stderr
    assert "creating .venv" not in completed.stdout
    assert not (script_clone / ".venv").exists()


def test_the_script_does_nothing_if_the_stamp_is_valid(script_clone: Path) -> None:
    program = script_clone / "autograder/bootstrap.py"
    code = f"""
import runpy, json, pathlib
names = runpy.run_path({str(program)!r})
set_up = names["SetUp"](pathlib.Path({str(script_clone)!r}), names["Interpreter"].running(), None, None)
(set_up.venv / "bin").mkdir(parents=True)
(set_up.venv / "bin/python").touch()
(set_up.venv / names["STAMP"]).write_text(json.dumps(set_up.expected_stamp(dev=True)))
"""
    subprocess.run([Interpreter.running().executable, "-I", "-c", code], check=True, timeout=60)
    before = json.loads((script_clone / ".venv" / bootstrap.STAMP).read_text())
    completed = script(script_clone, "--dev")
    assert (completed.returncode, completed.stderr) == (0, "")
    assert "creating .venv" not in completed.stdout
    assert json.loads((script_clone / ".venv" / bootstrap.STAMP).read_text()) == before


def test_the_script_refuses_an_unknown_option(script_clone: Path) -> None:
    assert script(script_clone, "--nonsense").returncode == 2
