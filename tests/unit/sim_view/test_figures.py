"""Static pictures: their content, reproducible bytes, and no use of pyplot."""

from __future__ import annotations

import base64
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from sim import Command, Recording, Simulation, World, box, run, start
from sim.view import DARK, LIGHT, plot, show
from sim.view.marks import MARKS, OWN
from sim.view.shapes import outlines
from sim.view.stage import HEIGHT, WIDTH

ROOT = Path(__file__).resolve().parents[3]


def texts(ax: Axes) -> set[str]:
    return {text.get_text() for text in ax.texts}


def tracks(ax: Axes) -> list[LineCollection]:
    return [item for item in ax.collections if isinstance(item, LineCollection) and item.get_array() is not None]


def test_a_world_shows_its_walls_names_and_size(world: World) -> None:
    (ax,) = show(world).figure.axes
    assert {"The lab", "12.0 × 8.0 m", "north wall", "table", "dock"} <= texts(ax)  # noqa: RUF001
    walls = ax.collections[0]
    assert isinstance(walls, LineCollection)
    assert len(walls.get_segments()) == len(world.segments)


def test_names_can_be_omitted(world: World) -> None:
    (ax,) = show(world, names=False).figure.axes
    assert texts(ax) == {"The lab", "12.0 × 8.0 m"}  # noqa: RUF001


def test_a_picture_can_be_drawn_into_given_axes(world: World, recording: Recording) -> None:
    figure = Figure()
    left, right = figure.subplots(1, 2)
    assert show(world, ax=left).figure is figure
    assert plot(recording, ax=right).figure is figure
    assert left.collections
    assert right.collections


def test_the_same_drawing_gives_the_same_bytes(world: World, recording: Recording) -> None:
    assert show(world).png() == show(world).png()
    assert show(world).svg() == show(world).svg()
    assert plot(recording, mark=3.0).svg() == plot(recording, mark=3.0).svg()


def test_robots_and_their_scans_are_drawn_with_a_state(world: World) -> None:
    simulation = Simulation(world)
    bare, full = show(simulation), show(simulation, start(simulation))
    assert not [line for line in bare.figure.axes[0].lines if line.get_color() == LIGHT.hit]
    (hits,) = [line for line in full.figure.axes[0].lines if line.get_color() == LIGHT.hit]
    assert np.size(hits.get_xdata()) > 100
    assert "robot at (1.40 m, 0.80 m)" in full.alt


def test_a_track_states_its_duration_and_its_collisions(recording: Recording) -> None:
    picture = plot(recording)
    title = " ".join(texts(picture.figure.axes[0]))
    collisions = sum(event.kind == "collision" for event in recording.events)
    assert collisions
    assert f"{collisions} collision" in title
    assert "8.0 s" in title
    assert f"{collisions} collision" in picture.alt


def test_the_heading_for_several_robots_omits_the_nearest_obstacle(recording: Recording) -> None:
    several, one = plot(recording), plot(recording, robot="two")
    nearest = "never nearer than"
    assert nearest not in " ".join(texts(several.figure.axes[0]))
    assert nearest in " ".join(texts(one.figure.axes[0]))
    assert nearest in several.alt


@pytest.mark.parametrize(("colour", "values"), [("time", "times"), ("clearance", "clearances")])
def test_a_track_is_coloured_by_time_or_clearance(recording: Recording, colour: str, values: str) -> None:
    picture = plot(recording, robot="one", colour=colour)  # type: ignore[arg-type]
    (track,) = tracks(picture.figure.axes[0])
    column = getattr(recording, values)
    column = column if column.ndim == 1 else column[:, 0]
    assert np.array(track.get_array()) == pytest.approx((column[1:] + column[:-1]) / 2)
    scale = picture.figure.axes[0].child_axes[0]
    assert isinstance(scale, Axes)
    assert colour in texts(scale)


def test_one_robot_can_be_selected(recording: Recording) -> None:
    picture = plot(recording, robot="two")
    (track,) = tracks(picture.figure.axes[0])
    assert track.get_segments()[0][0] == pytest.approx(recording.poses[0, 1, :2])
    assert "Track of two" in picture.alt


def test_each_robot_has_the_colour_of_its_track(recording: Recording) -> None:
    ax = plot(recording).figure.axes[0]
    colours = {tuple(track.get_segments()[0][0]): track.get_cmap()(0.5) for track in tracks(ax)}
    for index in range(2):
        assert colours[tuple(recording.poses[0, index, :2])] == pytest.approx(
            to_rgba(LIGHT.robot_colour(index)), abs=0.01
        )


def test_a_mark_shows_its_instant_and_its_note(recording: Recording) -> None:
    picture = plot(recording, mark=3.04, note="0.08 m from the north wall")
    assert "t = 3.0 s\n0.08 m from the north wall" in texts(picture.figure.axes[0])
    assert "Marked: t = 3.0 s, 0.08 m from the north wall" in picture.alt


def test_the_mark_draws_a_line_to_the_nearest_obstacle(recording: Recording) -> None:
    row = int(np.argmin(recording.clearances[:, 0]))
    ax = plot(recording, mark=float(recording.times[row]), robot="one").figure.axes[0]
    endpoints = [np.column_stack(line.get_data()) for line in ax.lines if np.size(line.get_xdata()) == 2]
    gap = next(line for line in endpoints if line[0] == pytest.approx(recording.poses[row, 0, :2]))
    spec = recording.simulation.robots[0]
    assert np.hypot(*(gap[1] - gap[0])) == pytest.approx(recording.clearances[row, 0] + spec.radius, abs=1e-9)


def test_without_a_mark_the_closest_point_is_drawn_with_its_distance(world: World) -> None:
    safe = run(Simulation(world), lambda state, scans: Command(0.2, 0.0), 4.0)
    row = int(np.argmin(safe.clearances[:, 0]))
    ax = plot(safe).figure.axes[0]
    assert f"{safe.clearances[row, 0]:.2f} m" in texts(ax)
    (gap,) = [np.column_stack(line.get_data()) for line in ax.lines if line.get_linewidth() == MARKS["closest"].width]
    assert gap[0] == pytest.approx(safe.poses[row, 0, :2])
    assert np.hypot(*(gap[1] - gap[0])) == pytest.approx(safe.clearances[row, 0] + safe.simulation.robots[0].radius)


def test_robots_are_named_if_there_are_several(world: World, recording: Recording) -> None:
    assert {"one", "two"} <= texts(plot(recording).figure.axes[0])
    assert {"one", "two"} <= texts(show(recording.simulation, start(recording.simulation)).figure.axes[0])
    single = Simulation(world)
    assert single.robots[0].name not in texts(show(single, start(single)).figure.axes[0])


def test_each_mark_has_colours_that_each_theme_names() -> None:
    used = {colour for mark in MARKS.values() for colour in (mark.fill, mark.line)} - {"", OWN}
    assert used <= LIGHT.named.keys() == DARK.named.keys()


def test_a_mark_outside_the_recording_takes_its_nearest_instant(recording: Recording) -> None:
    assert "t = 8.0 s" in texts(plot(recording, mark=99.0).figure.axes[0])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"robot": "three"}, "no robot 'three': it has one, two"),
        ({"colour": "speed"}, "no colour 'speed': choose time or clearance"),
        ({"mark": float("nan")}, "no instant t = nan s"),
        ({"theme": "sepia"}, "no theme 'sepia': choose one of light, dark"),
    ],
)
def test_invalid_arguments_are_named(recording: Recording, arguments: dict[str, str | float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        plot(recording, **arguments)  # type: ignore[arg-type]


def test_a_picture_is_saved_as_png_or_svg_only(world: World, tmp_path: Path) -> None:
    picture = show(world)
    assert picture.save(tmp_path / "a.png").read_bytes() == picture.png()
    assert ElementTree.parse(picture.save(tmp_path / "a.svg")).getroot().tag.endswith("svg")
    for name in ("a.pdf", "a"):
        with pytest.raises(ValueError, match=r"saved as \.png or \.svg"):
            picture.save(tmp_path / name)


def test_a_picture_shows_itself_with_its_alternative_text() -> None:
    picture = show(World.from_segments(box(2, 2), name='a "quoted" <b> world'))
    data, metadata = picture._repr_mimebundle_()
    assert base64.b64decode(data["image/png"]) == picture._repr_png_()
    assert 'alt="Map of the world “a &quot;quoted&quot; &lt;b&gt; world”' in data["text/html"]
    assert metadata["image/png"]["alt"] == data["text/plain"] == picture.alt


@pytest.mark.parametrize("size", [(0.5, 0.5), (60.0, 1.0), (1.0, 60.0), (500.0, 500.0)])
def test_worlds_of_any_size_fit_on_the_sheet(size: tuple[float, float]) -> None:
    figure = show(World.from_segments(box(*size))).figure
    assert figure.get_figwidth() <= WIDTH + 0.01
    assert figure.get_figheight() <= HEIGHT + 0.01
    assert 2 <= len(figure.axes[0].get_xticks()) + len(figure.axes[0].get_yticks()) <= 40


def test_a_world_without_walls_can_be_shown() -> None:
    assert show(World()).png().startswith(b"\x89PNG")


def test_furniture_is_filled_and_the_room_is_not(world: World) -> None:
    room, solid = outlines(world)
    assert np.ptp(room, axis=0).tolist() == [12.0, 8.0]
    assert len(solid) == 4


def luminance(colour: str) -> float:
    channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_text_has_the_contrast_that_wcag_asks_for(theme: object) -> None:
    for foreground in ("ink", "muted", "goal", "alarm"):
        for background in ("paper", "floor", "outside"):
            values = sorted(luminance(getattr(theme, name)) for name in (foreground, background))
            assert (values[1] + 0.05) / (values[0] + 0.05) >= 4.5, (foreground, background)


@pytest.mark.slow
def test_bridge_maps_and_export_import_no_drawing_library_and_the_view_imports_no_pyplot() -> None:
    code = """
import sys
import sim.bridge, sim.maps, sim.export
assert not {"matplotlib", "rclpy", "ipywidgets", "anywidget"} & set(sys.modules)
import sim.view
sim.view.show(sim.World.from_segments(sim.box(2, 2))).png()
assert not {"matplotlib.pyplot", "ipywidgets", "anywidget", "rclpy"} & set(sys.modules)
"""
    completed = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert completed.returncode == 0, completed.stderr
