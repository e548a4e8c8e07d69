"""Many starts and stops, stopped at different moments: never is anything left over or stuck.

Each moment comes four times in `make test`, and thirty times in `make nightly`.
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


def _left_over(mark: str) -> list[str]:
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        if int(folder.name) == os.getpid():
            continue
        try:
            if f"{MARK}={mark}".encode() in (folder / "environ").read_bytes():
                found.append((folder / "cmdline").read_text().replace("\0", " "))
        except OSError:
            # It has just ended.
            continue
    return found


@pytest.fixture
def mark(own_log: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A variable that marks all processes of this test in their environment."""
    monkeypatch.setenv(MARK, str(tmp_path))
    return str(tmp_path)


@pytest.mark.parametrize("starts", [12, pytest.param(90, marks=pytest.mark.nightly)])
def test_many_launches_of_light_processes_leave_nothing(
    starts: int, fleet: Path, mark: str, capsys: pytest.CaptureFixture[str]
) -> None:
    left, codes = [], set()
    for number in range(starts):
        service = launch.LaunchService()
        light = ExecuteProcess(cmd=[str(fleet / "lib/fleet/light")], output="screen")
        other = ExecuteProcess(cmd=["sleep", "3600"])
        # A shell with a child in the background, which ignores SIGINT; stopped before it waits, dash misses it too.
        shell = ExecuteProcess(cmd=["sleep 3600 & echo up; wait"], shell=True)
        moments = (
            (other, OnProcessStart(target_action=light, on_start=_interrupt)),
            (other, OnProcessIO(target_action=light, on_stdout=_interrupt)),
            (shell, OnProcessIO(target_action=shell, on_stdout=_interrupt)),
        )
        second, handler = moments[number % len(moments)]
        service.include_launch_description(launch.LaunchDescription([RegisterEventHandler(handler), light, second]))
        codes.add(service.run())
        left += _left_over(mark)
    said = capsys.readouterr().out
    assert (left, codes) == ([], {0})
    assert said.count("process started with pid") == 2 * starts


def test_launches_of_nodes_that_are_stopped_early_or_late_leave_nothing(start: Callable[..., Any]) -> None:
    for number in range(NODE_STARTS):
        running = start("two_robots")
        early = number % 2 == 1
        running.wait_for("process started with pid" if early else r"(?s)(ready: /robot.*){3}")
        assert running.interrupt() == 0
        assert running.members() == {}
        # A Python that is interrupted while it starts may miss that, and is then ended by SIGTERM.
        assert early or "escalating" not in running.text
