"""Many launches, stopped at different moments, leave no process behind and do not hang.

`make test` stops at each moment four times, and `make nightly` thirty times.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import launch
import pytest
from launch.actions import ExecuteProcess, RegisterEventHandler
from launch.event_handlers import OnProcessIO, OnProcessStart

NODE_STARTS = 2
MARK = "COURSE_LAUNCH_MARK"


def _interrupt(*_: Any) -> None:
    os.kill(os.getpid(), signal.SIGINT)


def _leftovers(mark: str) -> list[str]:
    commands = []
    for folder in Path("/proc").glob("[0-9]*"):
        if int(folder.name) == os.getpid():
            continue
        try:
            if f"{MARK}={mark}".encode() in (folder / "environ").read_bytes():
                commands.append((folder / "cmdline").read_text().replace("\0", " "))
        except OSError:
            continue  # the process has just ended
    return commands


@pytest.fixture
def mark(own_log: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A variable that marks all processes of this test in their environment."""
    monkeypatch.setenv(MARK, str(tmp_path))
    return str(tmp_path)


@pytest.mark.parametrize("starts", [12, pytest.param(90, marks=pytest.mark.nightly)])
def test_many_launches_of_light_processes_leave_nothing(
    starts: int, fleet: Path, mark: str, capsys: pytest.CaptureFixture[str]
) -> None:
    leftovers, codes = [], set()
    for number in range(starts):
        service = launch.LaunchService()
        light = ExecuteProcess(cmd=[str(fleet / "lib/fleet/light")], output="screen")
        sleeper = ExecuteProcess(cmd=["sleep", "3600"])
        # A shell whose background child ignores SIGINT. Stopped before it waits, dash misses the signal, too.
        shell = ExecuteProcess(cmd=["sleep 3600 & echo up; wait"], shell=True)
        moments = (
            (sleeper, OnProcessStart(target_action=light, on_start=_interrupt)),
            (sleeper, OnProcessIO(target_action=light, on_stdout=_interrupt)),
            (shell, OnProcessIO(target_action=shell, on_stdout=_interrupt)),
        )
        second, handler = moments[number % len(moments)]
        service.include_launch_description(launch.LaunchDescription([RegisterEventHandler(handler), light, second]))
        codes.add(service.run())
        leftovers += _leftovers(mark)
    output = capsys.readouterr().out
    assert (leftovers, codes) == ([], {0})
    assert output.count("process started with pid") == 2 * starts


def test_launches_of_nodes_that_are_stopped_early_or_late_leave_nothing(start: Callable[..., Any]) -> None:
    for number in range(NODE_STARTS):
        launched = start("two_robots")
        stops_early = number % 2 == 1
        launched.wait_for("process started with pid" if stops_early else r"(?s)(ready: /robot.*){3}")
        assert launched.interrupt() == 0
        assert launched.members() == {}
        # Python may miss an interrupt while it starts, and is then ended by SIGTERM.
        assert stops_early or "escalating" not in launched.text
