"""A set-up is made once, whole or not at all, and names the step that failed."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from autograder import bootstrap
from autograder.bootstrap import Interpreter, SetUp, SetUpError
from autograder.ros.distribution import DISTRIBUTION

PY312 = Interpreter("/usr/bin/python3.12", "3.12", "3.12.1 (main)", ".cpython-312-x86_64-linux-gnu.so")


@pytest.fixture
def set_up(clone: Path, commands: Any) -> SetUp:
    return SetUp(clone, PY312, None, commands)


@pytest.mark.promise("make setup")
def test_a_set_up_is_created_once(set_up: SetUp, commands: Any, capsys: pytest.CaptureFixture[str]) -> None:
    set_up.make(dev=False)
    assert commands.take() == ["venv", "base", "patch", "launch", "project", "tutorials"]
    output = capsys.readouterr().out
    assert output.startswith(f"set-up: creating .venv with Python 3.12.1 and ROS 2 {DISTRIBUTION.title} from wheels\n")
    set_up.make(dev=False)
    assert commands.take() == []
    assert capsys.readouterr().out == ""


def test_packages_of_the_tests_are_added_to_a_finished_set_up_and_kept(set_up: SetUp, commands: Any) -> None:
    set_up.make(dev=False)
    commands.take()
    set_up.make(dev=True)
    assert commands.take() == ["dev", "patch", "launch", "project", "tutorials"]
    set_up.make(dev=False)
    set_up.make(dev=True)
    assert commands.take() == []


def test_packages_of_the_tests_are_installed_at_once_if_there_is_no_set_up(set_up: SetUp, commands: Any) -> None:
    set_up.make(dev=True)
    assert commands.take() == ["venv", "dev", "patch", "launch", "project", "tutorials"]
    assert set_up.missing_parts(dev=False) == []


@pytest.mark.parametrize(
    ("changed", "repeated_steps"),
    [
        ("requirements.lock", ["venv", "base", "patch", "launch", "project", "tutorials"]),
        ("autograder/ros/patch_wheels.py", ["venv", "base", "patch", "launch", "project", "tutorials"]),
        ("pyproject.toml", ["patch", "launch", "project", "tutorials"]),
        ("autograder/building/interfaces/tutorials.yaml", ["patch", "launch", "project", "tutorials"]),
        ("requirements-dev.lock", []),
    ],
)
def test_a_changed_file_repeats_the_steps_that_depend_on_it(
    set_up: SetUp, commands: Any, changed: str, repeated_steps: list[str]
) -> None:
    set_up.make(dev=False)
    commands.take()
    (set_up.root / changed).write_text("another\n")
    set_up.make(dev=False)
    assert commands.take() == repeated_steps


@pytest.mark.parametrize("change", [{"sourced": "/opt/ros/sourced"}, {"interpreter": replace(PY312, build="3.12.2")}])
def test_a_different_ros_or_interpreter_repeats_the_whole_set_up(
    set_up: SetUp, commands: Any, change: dict[str, object]
) -> None:
    set_up.make(dev=False)
    commands.take()
    replace(set_up, **change).make(dev=False)  # type: ignore[arg-type]
    assert commands.take()[0] == "venv"


def test_a_moved_clone_repeats_the_whole_set_up(set_up: SetUp, commands: Any, tmp_path: Path) -> None:
    set_up.make(dev=False)
    moved_set_up = replace(set_up, root=set_up.root.rename(tmp_path / "moved"))
    assert moved_set_up.missing_parts(dev=False) == ["base"]


def test_an_environment_without_its_interpreter_is_created_again(set_up: SetUp) -> None:
    set_up.make(dev=False)
    (set_up.venv / "bin/python").unlink()
    assert set_up.missing_parts(dev=False) == ["base", "project"]


@pytest.mark.parametrize("stamp", ["", "half a {", "[]"])
def test_an_unreadable_stamp_counts_as_a_missing_stamp(set_up: SetUp, stamp: str) -> None:
    set_up.make(dev=False)
    (set_up.venv / bootstrap.STAMP).write_text(stamp)
    assert set_up.missing_parts(dev=False) == ["base", "project"]


@pytest.mark.promise("Run the same `make` command again. It begins from the start.")
@pytest.mark.parametrize(
    "step", ["-m venv", "requirements.lock", "-e ", "ros.patch_wheels", "ros.real_launch", "interfaces.tutorials"]
)
def test_an_interrupted_set_up_starts_from_the_beginning(set_up: SetUp, commands: Any, step: str) -> None:
    commands.interrupting = step
    with pytest.raises(KeyboardInterrupt):
        set_up.make(dev=False)
    commands.interrupting = ""
    commands.take()
    set_up.make(dev=False)
    assert commands.take() == ["venv", "base", "patch", "launch", "project", "tutorials"]


def test_an_interrupted_addition_of_test_packages_is_repeated_from_the_start(set_up: SetUp, commands: Any) -> None:
    set_up.make(dev=False)
    commands.interrupting = "requirements-dev.lock"
    with pytest.raises(KeyboardInterrupt):
        set_up.make(dev=True)
    commands.interrupting = ""
    commands.take()
    set_up.make(dev=False)
    assert commands.take() == ["venv", "base", "patch", "launch", "project", "tutorials"]


@pytest.mark.parametrize(
    ("step", "message"),
    [
        ("-m venv", "the virtual environment could not be created"),
        ("requirements.lock", "pip could not install requirements.lock, for the reason above; set proxies"),
        ("-e ", "the project could not be installed"),
        ("ros.patch_wheels", "the ROS wheels could not be patched"),
    ],
)
def test_a_failed_step_is_named_with_its_command(set_up: SetUp, commands: Any, step: str, message: str) -> None:
    commands.failing = step
    with pytest.raises(SetUpError) as error:
        set_up.make(dev=False)
    assert str(error.value).startswith(message)
    assert "exit status 3 of `" in str(error.value)
    assert set_up.missing_parts(dev=False) == ["base", "project"]


def test_a_set_up_continues_if_the_real_launch_cannot_be_installed(set_up: SetUp, commands: Any) -> None:
    commands.failing = "ros.real_launch"
    set_up.make(dev=False)
    assert commands.take() == ["venv", "base", "patch", "launch", "project", "tutorials"]
    assert set_up.missing_parts(dev=False) == []


def test_another_commit_of_the_real_launch_repeats_the_steps_that_depend_on_it(
    set_up: SetUp, commands: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    set_up.make(dev=False)
    commands.take()
    monkeypatch.setitem(bootstrap.ROS, "commits", {"launch": "c0de"})
    set_up.make(dev=False)
    assert commands.take() == ["patch", "launch", "project", "tutorials"]


@pytest.mark.parametrize("standins", [True, False])
def test_the_choice_of_the_stand_ins_repeats_the_steps_that_depend_on_it(
    set_up: SetUp, commands: Any, standins: bool
) -> None:
    replace(set_up, standins=not standins).make(dev=False)
    commands.take()
    replace(set_up, standins=standins).make(dev=False)
    assert commands.take() == ["patch", "launch", "project", "tutorials"]


@pytest.mark.promise(
    "`make real-launch` tries again.",
    "`make real-launch` also tries again, and fails if it cannot install the packages.",
)
def test_a_requested_real_launch_is_installed_again_and_a_failure_is_reported(set_up: SetUp, commands: Any) -> None:
    set_up.make(dev=False)
    commands.take()
    commands.failing = "ros.real_launch"
    with pytest.raises(SetUpError, match="the real launch could not be installed, for the reason above"):
        set_up.make(dev=False, real_launch=True)
    assert f"{set_up.python} -m autograder.ros.real_launch" in commands.ran  # without --set-up, which hides failures
    assert set_up.missing_parts(dev=False) == []


def test_a_python_without_ensurepip_gets_pip_from_the_systems_pip(set_up: SetUp, commands: Any) -> None:
    commands.failing = "import ensurepip"
    set_up.make(dev=False)
    assert "--without-pip" in commands.ran[1]
    assert f"--target {set_up.venv}/lib/python3.12/site-packages pip" in commands.ran[2]


@pytest.mark.promise("`sudo apt-get install python3-venv`")
def test_a_python_without_pip_is_reported_with_the_package_to_install(set_up: SetUp, commands: Any) -> None:

    def run(*command: str, quiet: bool = False) -> int:
        return 1 if "import ensurepip; ensurepip.version()" in command or "--target" in command else commands(*command)

    with pytest.raises(SetUpError, match=r"neither ensurepip nor pip works .* install python3-venv or python3-pip"):
        replace(set_up, run=run).make(dev=False)


def test_with_a_sourced_ros_the_wheels_of_ros_are_not_installed(set_up: SetUp, commands: Any) -> None:
    replace(set_up, sourced="/opt/ros/sourced/lib/python3.12/site-packages").make(dev=False)
    lock = (set_up.root / "requirements.lock").read_text()
    assert (set_up.venv / "requirements.lock").read_text() == bootstrap.without_ros(lock) != lock
    assert f"-r {set_up.venv}/requirements.lock" in " ".join(commands.ran)
    assert commands.take() == ["venv", "base", "patch", "project"]
    set_up.make(dev=False)
    assert (set_up.venv / "requirements.lock").read_text() == lock


def test_two_set_ups_of_one_clone_run_one_after_the_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lock = tmp_path / ".build" / "lock"
    waiting, entered = threading.Event(), threading.Event()
    monkeypatch.setattr(bootstrap, "print_progress", lambda line: waiting.set())

    def second_set_up() -> None:
        with bootstrap.exclusive_set_up(lock):
            entered.set()

    thread = threading.Thread(target=second_set_up)
    with bootstrap.exclusive_set_up(lock):
        assert not waiting.is_set()
        thread.start()
        assert waiting.wait(timeout=60)
        assert not entered.is_set()
    assert entered.wait(timeout=60)
    thread.join(timeout=60)
