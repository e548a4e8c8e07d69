"""Commands in a notebook: their output, how they end, and how the programs that they started end."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from autograder.exceptions import UsageError
from autograder.notebook import terminal
from autograder.notebook.terminal import running, shell
from autograder.submission.exercise_stubs import STILL_TO_BE_WRITTEN
from sim.grading import GRADING_VARIABLE

STUBBORN = f"""{sys.executable} -c "
import signal
signal.signal(signal.SIGINT, signal.SIG_IGN)
print('up', flush=True)
signal.pause()
" """


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    return tmp_path


def is_alive(pid: int) -> bool:
    stat = Path(f"/proc/{pid}/stat")
    return stat.exists() and stat.read_text().rpartition(")")[2].split()[0] != "Z"


def test_a_command_runs_to_its_end_and_prints_both_its_streams(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shell("echo out; echo error >&2", workspace=workspace)
    assert capsys.readouterr().out == "out\nerror\n"


def test_a_failed_command_shows_its_exit_status(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shell("exit 3", workspace=workspace)
    assert capsys.readouterr().out == "[exit status 3]\n"


def test_a_command_that_does_not_end_is_interrupted_after_its_time(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shell(
        "trap 'echo interrupted; exit 0' INT; echo up; while true; do sleep 0.1; done", seconds=1.0, workspace=workspace
    )
    assert capsys.readouterr().out == "up\n[Ctrl-C after 1 s]\ninterrupted\n"


def test_a_built_workspace_is_sourced(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (workspace / "install").mkdir()
    (workspace / "install" / "local_setup.bash").write_text("export WORD=sourced\n")
    shell("echo $WORD", workspace=workspace)
    assert capsys.readouterr().out == "sourced\n"


def test_a_build_of_unwritten_files_is_not_run(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("mine", "given"):
        (workspace / "src" / name).mkdir(parents=True)
    (workspace / "src" / "mine" / "setup.py").write_text(f"raise NotImplementedError('{STILL_TO_BE_WRITTEN}')\n")
    for command in ("colcon build", "X=1 colcon --log-level error build --packages-select given mine | tail -n 1"):
        shell(f"true && {command}", workspace=workspace)
        output = capsys.readouterr().out
        assert (
            output
            == "src/mine/setup.py is still to be written: replace the line raise NotImplementedError(...) with yours.\n"
        )
    for command in ("echo colcon build --packages-select given", "echo colcon test"):
        shell(command, workspace=workspace)
        assert capsys.readouterr().out == command.removeprefix("echo ") + "\n"


def test_a_command_runs_without_pythondontwritebytecode(
    workspace: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    shell('echo "[$PYTHONDONTWRITEBYTECODE]"', workspace=workspace)
    assert capsys.readouterr().out == "[]\n"


def test_the_courses_own_commands_are_found(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shell("ros2 --help | head -1", workspace=workspace)
    assert "usage: ros2" in capsys.readouterr().out


def test_the_block_begins_after_the_awaited_text_and_ctrl_c_ends_the_command(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with running("echo $$; echo ready; sleep 600", until="ready", workspace=workspace):
        pid = int(capsys.readouterr().out.split()[0])
        assert is_alive(pid)
    assert not is_alive(pid)


def test_a_block_that_starts_without_the_awaited_text_reports_it(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with running("echo up; sleep 600", until=["up", "ready", "set"], seconds=0.5, workspace=workspace):
        assert capsys.readouterr().out == "up\n[not printed within 0.5 s: 'ready', 'set']\n"
    with running("echo up; exit 3", until="ready", workspace=workspace):
        pass
    assert capsys.readouterr().out == "up\n[exit status 3]\n"


def test_a_block_that_raises_leaves_nothing_running(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def fail() -> None:
        with running("echo $$; sleep 600", until="\n", workspace=workspace):
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert not is_alive(int(capsys.readouterr().out))


def test_a_command_that_ignores_ctrl_c_is_killed_and_reported(
    workspace: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminal, "STOP_SECONDS", 0.5)
    with running(STUBBORN, until="up", workspace=workspace):
        pass
    assert "after Ctrl-C: killed]" in capsys.readouterr().out


def test_no_command_runs_while_the_notebook_is_graded(
    workspace: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(GRADING_VARIABLE, "1")
    shell(f"touch {workspace / 'one'}", workspace=workspace)
    with running(f"touch {workspace / 'two'}", workspace=workspace):
        pass
    assert list(workspace.iterdir()) == []
    assert capsys.readouterr().out == 2 * f"{terminal.NOT_WHILE_GRADING}\n"


def test_a_missing_workspace_is_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"the folder .*nowhere does not exist: run this in the assignment's folder"):
        shell("true", workspace=tmp_path / "nowhere")
