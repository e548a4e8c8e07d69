"""World files: their contents, and a clear error with its line for each mistake."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sim import WorldError, load_world

GOOD = """\
name: test room
units: {length: cm, angle: deg}
walls:
  - {name: shelf, from: [0, 0], to: [150, 0]}
  - [0, 50, 1.5 m, 50]
boxes:
  - {size: [600, 400], center: [0, 0]}
  - {name: hut, size: [50, 50]}
polygons:
  - {name: crate, points: [[100, 100], [200, 100], [200, 200], [100, 100]]}
circles:
  - {name: pillar, center: [0, 100], radius: 20}
starts:
  - {x: -100, y: 0, theta: 90}
  - [0, 0, 3.14 rad]
goals:
  - {name: door, center: [200, 100]}
movers:
  - {name: cart, path: [[0, 0], [200, 0]], radius: 20, speed: 30, pause: 1, loop: true, phase: 0.5}
"""


def write(folder: Path, text: str | bytes) -> Path:
    path = folder / "world.yaml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def test_each_object_of_a_world_file_is_read_with_its_name_and_in_metres(tmp_path: Path) -> None:
    world = load_world(write(tmp_path, GOOD))
    assert world.name == "test room"
    assert len(world.segments) == 2 + 4 + 4 + 3
    np.testing.assert_array_equal(world.segments[:2], [[0, 0, 1.5, 0], [0, 0.5, 1.5, 0.5]])
    assert world.segment_names[0:3] == ("shelf", "", "south wall")
    assert world.segment_names[6:11] == ("hut south wall", "hut east wall", "hut north wall", "hut west wall", "crate")
    np.testing.assert_allclose(world.circles, [[0, 1, 0.2]])
    assert world.circle_names == ("pillar",)
    assert world.starts[0].theta == pytest.approx(math.pi / 2)
    assert world.starts[1].theta == 3.14
    assert (world.goals[0].name, world.goals[0].x, world.goals[0].radius) == ("door", 2.0, 0.25)
    mover = world.movers[0]
    assert (mover.path, mover.radius, mover.speed) == (((0.0, 0.0), (2.0, 0.0)), 0.2, 0.3)
    assert (mover.pause, mover.loop, mover.phase) == (1.0, True, 0.5)
    assert world.bounds == (-3.0, -2.0, 3.0, 2.0)
    assert not world.segments.flags.writeable


def test_a_world_file_needs_only_one_wall(tmp_path: Path) -> None:
    world = load_world(write(tmp_path, "walls: [[0, 0, 1e0, 0]]\ngoals:\n"))
    assert (world.name, len(world.segments), len(world.starts)) == ("world", 1, 1)


def test_the_worlds_of_the_course_can_be_read(request: pytest.FixtureRequest) -> None:
    paths = sorted((request.config.rootpath / "assets" / "worlds").glob("*.yaml"))
    worlds = {path: yaml.safe_load(path.read_text(encoding="utf-8")) for path in paths}
    assert worlds
    for path, data in worlds.items():
        if "image" not in data:  # that is a map
            assert len(load_world(path).segments) > 0


# The text of the file, the line that the error names, and its message.
BAD: list[tuple[str | bytes, int | None, str]] = [
    ("", 1, "the file is empty. Give it walls"),
    ("# nothing\n", 1, "the file is empty"),
    ("walls\n", 1, "a world is a mapping, not 'walls'"),
    ("- 1\n- 2\n", 1, "a world is a mapping, not a list of 2. Begin with a line like `walls:`"),
    ("name: x\n", 1, "the world is empty. Give it walls"),
    ("walls:\n", 1, "the world is empty"),
    ("walls: []\n", 1, "the world is empty"),
    ("a: 1\nb: [\n", 3, "this is not YAML"),
    ("walls:\n\t- [0, 0, 1, 1]\n", 2, "this is not YAML"),
    ("walls: [0, 0\ncircles: }\n", 2, "this is not YAML"),
    ("walls: *nobody\n", 1, "this is not YAML: found undefined alias"),
    ("walls: []\n---\nwalls: []\n", 2, "this is not YAML: expected a single document"),
    ("walls: 'abc\n", 2, "this is not YAML"),
    ("walls: [[0,0,1,1]]\nname: \x01\n", 2, "a character that YAML does not allow"),
    (b"name: a\nwalls: \xff\xfe\n", 2, "the file is not UTF-8 text. Save it as UTF-8"),
    ("wals:\n  - [0, 0, 1, 1]\n", 1, "the world has no field 'wals'. Did you mean 'walls'?"),
    ("name: x\ncolour: red\nwalls: [[0,0,1,1]]\n", 2, "the world has no field 'colour'. It can have"),
    ("walls: [[0,0,1,1]]\nwalls: [[0,0,1,1]]\n", 2, "the world has the field 'walls' twice"),
    ("? [1, 2]\n: 3\n", 1, "the world has no field 'a list of 2'"),
    ("image: map.pgm\nresolution: 0.05\n", 1, "this is a map of ROS's map_server"),
    ("name: [a, b]\n", 1, "name is a list of 2. Give a text"),
    ("walls: 3\n", 1, "walls is '3'. Give a list"),
    ("walls: {a: 1}\n", 1, "walls is a mapping. Give a list"),
    ("walls:\n  - 3\n", 2, "a wall is '3'. Give a mapping with 'from', 'to' and 'name'"),
    ("walls:\n  - \n", 2, "a wall is nothing"),
    ("walls:\n  - [0, 0, 1]\n", 2, "a wall is a list of 3. Give 4"),
    ("walls:\n  - [0, 0, 1, 1, 1]\n", 2, "a wall is a list of 5. Give 4"),
    ("walls:\n  - [0, 0, 1, x]\n", 2, "a wall is 'x'. Give a number, in m or cm or mm"),
    ("walls:\n  - [0, 0, 1, .nan]\n", 2, "a wall is '.nan'. Give a number"),
    ("walls:\n  - [0, 0, 1, .inf]\n", 2, "a wall is '.inf'"),
    ("walls:\n  - [0, 0, 1, 1e999]\n", 2, "a wall is '1e999'"),
    ("walls:\n  - [0, 0, 1, 2e5]\n", 2, "a wall is 200000 m. Keep within 100000 m"),
    ("walls:\n  - [0, 0, 1, 5 deg]\n", 2, "a wall is '5 deg'. Give a number, in m"),
    ("walls:\n  - [0, 0, 1, 5 feet]\n", 2, "a wall is '5 feet'"),
    ("walls:\n  - [0, 0, 1, [1]]\n", 2, "a wall is a list of 1"),
    ("walls:\n  - [0, 0, 1, true]\n", 2, "a wall is 'true'"),
    ("walls:\n  - [0, 0, 1, ]\n", 2, "a wall is a list of 3"),
    ("walls:\n  - [1, 1, 1, 1]\n", 2, "the wall has no length"),
    ("walls:\n  - {from: [0, 0]}\n", 2, "a wall lacks 'to'. Add it"),
    ("walls:\n  - {from: [0, 0], too: [1, 1]}\n", 2, "a wall has no field 'too'. Did you mean 'to'?"),
    ("walls:\n  - {from: 0, to: [1, 1]}\n", 2, "from is '0'. Give a list"),
    ("walls:\n  - {from: [0, 0], to: [1]}\n", 2, "to is a list of 1. Give 2"),
    ("walls:\n  - {from: [0, 0], to: [1, 1], name: {a: b}}\n", 2, "name is a mapping. Give a text"),
    (f"walls:\n  - {{from: [0, 0], to: [1, 1], name: {'x' * 201}}}\n", 2, "name is not a short text"),
    ('walls:\n  - {from: [0, 0], to: [1, 1], name: "a\\nb"}\n', 2, "name is not a short text"),
    ("walls: &a\n  - *a\n", 1, "a wall is a list of 1. Give 4"),
    ("units: metres\nwalls: [[0,0,1,1]]\n", 1, "units is 'metres'. Give a mapping with 'length' and 'angle'"),
    ("units: {length: ft}\nwalls: [[0,0,1,1]]\n", 1, "length is 'ft'. Give m or cm or mm"),
    ("units: {angle: grad}\n", 1, "angle is 'grad'. Give rad or deg"),
    ("boxes:\n  - {size: [1]}\n", 2, "size is a list of 1. Give 2"),
    ("boxes:\n  - {size: [1, 0]}\n", 2, "size is 0 m. Give a length above zero"),
    ("boxes:\n  - {center: [1, 0]}\n", 2, "a box lacks 'size'"),
    ("polygons:\n  - {points: [[0, 0], [1, 0]]}\n", 2, "points is a list of 2. Give 3 or more"),
    ("polygons:\n  - {points: [[0, 0], [1, 0], [0, 0]]}\n", 2, "a polygon of 2 points. Give three or more"),
    ("polygons:\n  - points:\n    - [0, 0]\n    - [1, 0]\n    - [1, 0]\n    - [1, 1]\n", 5, "two neighbouring points"),
    ("polygons:\n  - {points: [[0, 0], [1, 0], 5]}\n", 2, "a point is '5'. Give a list"),
    ("circles:\n  - {center: [0, 0]}\n", 2, "a circle lacks 'radius'"),
    ("circles:\n  - {radius: 1, centre: [0, 0]}\n", 2, "a circle has no field 'centre'. Did you mean 'center'?"),
    ("circles:\n  - {center: [0, 0], radius: -1}\n", 2, "radius is -1 m. Give a length above zero"),
    ("starts:\n  - {x: 1}\n", 2, "a start pose lacks 'y'"),
    ("starts:\n  - [1, 2]\n", 2, "a start pose [x, y, theta] is a list of 2. Give 3"),
    ("starts:\n  - {x: 1, y: 2, theta: 90 m}\n", 2, "theta is '90 m'. Give a number, in rad or deg"),
    ("starts:\n  - {x: 1, y: 2, theta: 180}\n", 2, "theta is 180 rad. Give an angle within a turn; check the units"),
    (
        "circles:\n  - {center: [1, 2], radius: 1}\nstarts:\n  - {x: 1, y: 2}\n",
        4,
        "the start pose is inside the circle 0",
    ),
    ("goals:\n  - {center: [0, 0], radius: 0}\n", 2, "radius is 0 m"),
    ("goals:\n  - {radius: 1}\n", 2, "a goal lacks 'center'"),
    ("movers:\n  - {path: []}\n", 2, "path is a list of 0. Give 1 or more"),
    ("movers:\n  - {radius: 1}\n", 2, "a mover lacks 'path'"),
    ("movers:\n  - {path: [[0, 0]], speed: 0}\n", 2, "the speed of the mover 'mover' is 0.0. Give m/s"),
    ("movers:\n  - {path: [[0, 0]], radius: 0}\n", 2, "the radius of the mover 'mover' is 0.0"),
    ("movers:\n  - {path: [[0, 0]], pause: -1}\n", 2, "the pause of the mover 'mover' is -1.0. Give seconds"),
    ("movers:\n  - {path: [[0, 0]], pause: 1 s}\n", 2, "pause is '1 s'. Give a number"),
    ("movers:\n  - {path: [[0, 0]], phase: 2}\n", 2, "the phase of the mover 'mover' is 2.0"),
    ("movers:\n  - {path: [[0, 0]], loop: maybe}\n", 2, "loop is 'maybe'. Give true or false"),
    ("walls: !!python/object:os.system [1]\n", 1, "a wall is '1'"),
    ("a: " * 5 + "\n", 1, "this is not YAML"),
    ("walls: " + "[" * 20_000 + "]" * 20_000 + "\n", None, "the file is nested too deeply to read"),
]


@pytest.mark.parametrize(("text", "line", "message"), BAD, ids=range(len(BAD)))
def test_a_malformed_world_is_reported_with_file_line_and_error(
    tmp_path: Path, text: str | bytes, line: int | None, message: str
) -> None:
    path = write(tmp_path, text)
    with pytest.raises(WorldError, match=re.escape(message)) as excinfo:
        load_world(path)
    assert excinfo.value.path == str(path)
    assert excinfo.value.line == line
    assert str(excinfo.value).startswith(f"{path}:{line}: " if line else f"{path}: ")
    assert excinfo.value.remedy


def test_a_missing_or_too_large_file_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(WorldError, match=r"cannot be read .No such file"):
        load_world(tmp_path / "none.yaml")
    with pytest.raises(WorldError, match=r"cannot be read .Is a directory"):
        load_world(tmp_path)
    monkeypatch.setattr("sim.fields.MAX_BYTES", 10)
    with pytest.raises(WorldError, match="the file is larger than"):
        load_world(write(tmp_path, GOOD))


def test_a_world_too_large_to_use_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sim.worldfile.MAX_THINGS", 5)
    with pytest.raises(WorldError, match=r"there are 8 walls in all\. Keep to 5"):
        load_world(write(tmp_path, "boxes:\n- {size: [1, 1]}\n- {size: [2, 2]}\n"))
    with pytest.raises(WorldError, match=r"walls is a list of 6\. Give 0 to 5"):
        load_world(write(tmp_path, "walls: [[],[],[],[],[],[]]\n"))


def outcome(path: Path) -> str:
    """Return the world's name or the WorldError from loading a file. Any other exception fails the test."""
    try:
        return f"{path}: {load_world(path).name}"
    except WorldError as error:
        return str(error)


fuzz = settings(deadline=None, max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])


@pytest.mark.fuzz
@fuzz
@given(st.binary(max_size=300))
def test_any_bytes_are_a_world_or_a_clear_error(tmp_path: Path, data: bytes) -> None:
    assert outcome(write(tmp_path, data)).startswith(str(tmp_path))


@pytest.mark.slow
@pytest.mark.fuzz
@fuzz
@given(st.integers(0, len(GOOD) - 1), st.integers(0, 20), st.text(max_size=6))
def test_a_good_file_with_an_error_is_a_world_or_a_clear_error(
    tmp_path: Path, offset: int, cut: int, inserted: str
) -> None:
    text = GOOD[:offset] + inserted + GOOD[offset + cut :]
    assert outcome(write(tmp_path, text.encode("utf-8", "surrogatepass"))).startswith(str(tmp_path))


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(
            st.sampled_from(["from", "to", "name", "x", "y", "center", "radius", "path", "points"]), inner
        )
    ),
    max_leaves=12,
)
sections = ["name", "units", "walls", "boxes", "polygons", "circles", "starts", "goals", "movers"]


@pytest.mark.slow
@pytest.mark.fuzz
@fuzz
@given(st.dictionaries(st.sampled_from(sections), values, min_size=1))
def test_any_yaml_under_the_right_headings_is_a_world_or_a_clear_error(tmp_path: Path, data: dict[str, object]) -> None:
    assert outcome(write(tmp_path, yaml.safe_dump(data))).startswith(str(tmp_path))
