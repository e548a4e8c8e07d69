"""`python -m sim`: its verbs, and its errors for wrong calls."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from PIL import Image

from sim import Recording
from sim.__main__ import main

ROOT = Path(__file__).resolve().parents[3]
LAB = str(ROOT / "assets" / "worlds" / "lab.yaml")


def call(*arguments: str | Path) -> Result:
    return CliRunner().invoke(main, [str(argument) for argument in arguments], prog_name="python -m sim")


def test_help_says_how_to_start() -> None:
    result = call("--help")
    assert result.exit_code == 0
    assert "python -m sim WORLD" in result.output
    assert {"run", "picture", "plot", "export", "teleop"} <= set(result.output.split())
    assert "--ros-args" in call("run", "--help").output


@pytest.mark.parametrize("extra", [(), ("--scan",), ("--theme", "dark")])
def test_picture_draws_a_world_or_a_map(tmp_path: Path, extra: tuple[str, ...]) -> None:
    for world in (LAB, ROOT / "assets" / "worlds" / "office.yaml"):
        result = call("picture", world, tmp_path / "out.png", *extra)
        assert result.exit_code == 0, result.output
        assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")


def test_plot_and_export_take_a_saved_recording(recording: Recording, tmp_path: Path) -> None:
    recording.save(tmp_path / "run.npz")
    assert call("plot", tmp_path / "run.npz", tmp_path / "run.svg", "--mark", "1", "--note", "here").exit_code == 0
    assert (tmp_path / "run.svg").is_file()
    result = call("export", tmp_path / "run.npz", tmp_path / "run.html")
    assert result.exit_code == 0
    assert result.output.strip() == str(tmp_path / "run.html")
    assert call("export", tmp_path / "run.npz", tmp_path / "run.gif", "--speed", "4", "--fps", "5").exit_code == 0
    with Image.open(tmp_path / "run.gif") as image:
        assert image.n_frames == 1 + int(recording.times[-1] / 4.0 * 5.0)


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["nowhere.yaml"], 2, "'nowhere.yaml' does not exist"),
        ([LAB, "--speed", "0"], 2, "0.01<=x<=1000"),
        ([LAB, "--lidar", "sonar"], 2, "'sonar' is not one of"),
        (["picture", LAB, "out.bmp"], 1, "saved as .png or .svg"),
        (["picture", LAB, "nowhere/out.png"], 1, "No such file"),
        (["plot", LAB, "out.png"], 1, "not a recording"),
        (["export", LAB, "out.gif"], 1, "not a recording"),
        (["teleop"], 1, "run it in a terminal"),
        (["picture", str(ROOT / "LICENSE"), "out.png"], 1, "LICENSE"),
    ],
)
def test_wrong_calls_of_the_command_line_are_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], code: int, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    result = call(*arguments)
    assert result.exit_code == code, result.output
    assert message in result.output
    assert "Traceback" not in result.output
