"""Maps of nav2's map_server are read by its rules, or refused with a reason."""

from __future__ import annotations

import io
import math
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image

from sim import LidarSpec, Pose, RobotSpec, Simulation, WorldError, observe, start
from sim.maps import load, load_map

ROOT = Path(__file__).resolve().parents[3]
FIELDS = {
    "image": "map.pgm",
    "resolution": "0.5",
    "origin": "[0.0, 0.0, 0.0]",
    "negate": "0",
    "occupied_thresh": "0.65",
    "free_thresh": "0.25",
}
ROOM = np.full((6, 8), 254, dtype=np.uint8)
ROOM[[0, -1], :] = 0
ROOM[:, [0, -1]] = 0


def pgm(pixels: npt.NDArray[np.uint8]) -> bytes:
    return b"P5\n# made by a test\n%d %d\n255\n" % pixels.shape[::-1] + pixels.tobytes()


def png(image: Image.Image) -> bytes:
    stream = io.BytesIO()
    image.save(stream, "PNG")
    return stream.getvalue()


def write(folder: Path, picture: bytes | None = None, name: str = "map.pgm", /, **fields: str | None) -> Path:
    """Write a map with changed fields (None omits one); return the YAML's path."""
    if picture is None:
        picture = pgm(ROOM)
    (folder / name).write_bytes(picture)
    lines = [f"{key}: {value}" for key, value in (FIELDS | {"image": name} | fields).items() if value is not None]
    (folder / "map.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder / "map.yaml"


def test_a_room_becomes_the_two_faces_of_its_walls(tmp_path: Path) -> None:
    world = load_map(write(tmp_path))
    assert world.name == "map"
    assert world.bounds == (0.0, 0.0, 4.0, 3.0)
    assert len(world.segments) == 8
    assert set(np.unique(world.segments)) == {0.0, 0.5, 2.5, 3.0, 3.5, 4.0}
    assert world.starts == (Pose(2.0, 1.5, 0.0),)


def test_a_lidar_in_a_map_measures_the_cells(tmp_path: Path) -> None:
    lidar = LidarSpec(beams=4, angle_increment=math.pi / 2, range_max=10.0)
    simulation = Simulation(load_map(write(tmp_path)), robots=(RobotSpec(lidar=lidar),))
    scan = observe(simulation, start(simulation))
    assert scan is not None
    assert scan.ranges.tolist() == pytest.approx([1.5, 1.0, 1.5, 1.0])


def test_the_first_row_of_the_picture_is_the_north(tmp_path: Path) -> None:
    pixels = np.full((3, 2), 254, dtype=np.uint8)
    pixels[0, 1] = 0
    world = load_map(write(tmp_path, pgm(pixels)))
    assert world.bounds[1::2] == (0.5, 1.5)
    assert (world.segments[:, 1::2].min(), world.segments[:, 1::2].max()) == (1.0, 1.5)
    assert (world.segments[:, 0::2].min(), world.segments[:, 0::2].max()) == (0.5, 1.0)


def test_the_origin_moves_and_turns_a_map(tmp_path: Path) -> None:
    world = load_map(write(tmp_path, origin=f"[10.0, -5.0, {math.pi / 2}]"))
    assert world.bounds == pytest.approx((7.0, -5.0, 10.0, -1.0))
    assert (world.starts[0].x, world.starts[0].y, world.starts[0].theta) == pytest.approx((8.5, -3.0, math.pi / 2))


@pytest.mark.parametrize(
    ("shade", "fields", "is_wall"),
    [
        (0, {}, True),
        (254, {}, False),
        (205, {}, False),  # unknown: neither a wall nor free
        (89, {}, True),  # (255 - 89) / 255 = 0.651
        (90, {}, False),  # 0.647
        (254, {"negate": "1"}, True),
        (0, {"negate": "1"}, False),
        (120, {"mode": "scale", "occupied_thresh": "0.5"}, True),
        (100, {"mode": "raw"}, True),
        (65, {"mode": "raw"}, True),
        (64, {"mode": "raw"}, False),
        (101, {"mode": "raw"}, False),  # beyond 100 raw means unknown
        (255, {"mode": "raw"}, False),
    ],
)
def test_walls_have_the_threshold_of_map_server(
    tmp_path: Path, shade: int, fields: dict[str, str], is_wall: bool
) -> None:
    raw = fields.get("mode") == "raw"
    free, wall = (0, 100) if raw else (254, 0)
    if fields.get("negate") == "1":
        free, wall = wall, free
    pixels = np.full((5, 5), free, dtype=np.uint8)
    pixels[0, 0], pixels[2, 2] = wall, shade
    world = load_map(write(tmp_path, pgm(pixels), **fields))
    assert len(world.segments) == (8 if is_wall else 4)


def test_ascii_pgm_16_bit_pgm_and_png_give_the_same_map(tmp_path: Path) -> None:
    letters = b"P2 # a comment\n8 6\n255\n" + " ".join(map(str, ROOM.ravel())).encode()
    wide = b"P5\n8 6\n65535\n" + (ROOM.astype(">u2") * 257).tobytes()
    grey, colour = Image.fromarray(ROOM), Image.fromarray(ROOM).convert("RGB")
    expected = load_map(write(tmp_path)).segments
    for name, picture in (("a.pgm", letters), ("b.pgm", wide), ("c.png", png(grey)), ("d.png", png(colour))):
        assert np.array_equal(load_map(write(tmp_path, picture, name)).segments, expected)


def test_transparent_pixels_are_unknown_in_the_mode_scale(tmp_path: Path) -> None:
    pixels = np.dstack([ROOM, ROOM, ROOM, np.full_like(ROOM, 255)])
    pixels[0, 0, 3] = 0
    path = write(tmp_path, png(Image.fromarray(pixels)), "map.png", mode="scale")
    assert len(load_map(path).segments) == 10
    assert len(load_map(write(tmp_path, png(Image.fromarray(pixels)), "map.png")).segments) == 8


def test_the_course_s_map_loads_and_tolerance_straightens_it() -> None:
    path = ROOT / "assets" / "worlds" / "office.yaml"
    exact, simpler = load(path), load_map(path, tolerance=0.05)
    assert 0 < len(simpler.segments) < len(exact.segments)
    assert exact.bounds == pytest.approx(simpler.bounds, abs=0.05)


def test_load_also_reads_worlds() -> None:
    assert load(ROOT / "assets" / "worlds" / "lab.yaml").name == "the lab"


BAD_FIELDS: list[tuple[dict[str, str | None], str]] = [
    ({"image": None}, "map.yaml: 'image' missing"),
    ({"resolution": None, "origin": None}, "'resolution', 'origin' missing"),
    ({"image": "nowhere.pgm"}, "nowhere.pgm: there is no such picture"),
    ({"image": "."}, "there is no such picture"),
    ({"image": "/nowhere/map.pgm"}, "map.yaml: its picture /nowhere/map.pgm: there is no such picture"),
    ({"image": "[a, b]"}, "map.yaml:1: 'image' is not one value"),
    ({"image": "''"}, "map.yaml:1: 'image' is not one value"),
    ({"image": '"a\\0b.pgm"'}, "map.yaml:1: 'image' is not one value"),
    ({"image": "x" * 5000}, "can't be read"),
    ({"resolution": "abc"}, "map.yaml:2: 'abc' of 'resolution' is not a number"),
    ({"resolution": "0"}, "map.yaml:2: a cell of 0 m is not usable"),
    ({"resolution": "-0.05"}, "map.yaml:2: a cell of -0.05 m"),
    ({"resolution": ".nan"}, "map.yaml:2: '.nan' of 'resolution' is not a number"),
    ({"resolution": "nan"}, "map.yaml:2: nan of 'resolution' is not a usable number"),
    ({"resolution": "1e400"}, "map.yaml:2: 1e400 of 'resolution' is not a usable number"),
    ({"resolution": "{}"}, "map.yaml:2: 'resolution' is not one value"),
    ({"resolution": "1e5"}, "map.yaml:2: a cell of 100000 m"),
    ({"origin": "[0, 0]"}, "map.yaml:3: 'origin' is not three numbers"),
    ({"origin": "0"}, "map.yaml:3: 'origin' is not three numbers"),
    ({"origin": "[0, 0, north]"}, "map.yaml:3: 'north' of 'origin' is not a number"),
    ({"origin": "[0, 0, inf]"}, "map.yaml:3: inf of 'origin' is not a usable number"),
    ({"origin": "[0, 0, [1]]"}, "map.yaml:3: 'origin' is not three numbers"),
    ({"origin": "[1e9, 0, 0]"}, "map.yaml:3: 1e9 of 'origin' is not a usable number"),
    ({"negate": "maybe"}, "map.yaml:4: negate is 'maybe'"),
    ({"negate": "2"}, "map.yaml:4: negate is '2'"),
    ({"occupied_thresh": "1.5"}, "map.yaml:5: occupied_thresh is 1.5"),
    ({"free_thresh": "-0.1"}, "map.yaml:6: free_thresh is -0.1"),
    ({"free_thresh": "0.9"}, "map.yaml:6: free_thresh 0.9 is not below occupied_thresh 0.65"),
    ({"mode": "binary"}, "map.yaml:7: the mode 'binary' is unknown. Choose one of trinary, scale, raw"),
    ({"negate": "0\nnegate: 1"}, "map.yaml:5: 'negate' occurs twice"),
    ({"mode": "trinary\n  oops: [1"}, "not YAML"),
    ({"occupied_thresh": "1.0"}, "no cell is a wall"),
]


@pytest.mark.parametrize(("fields", "message"), BAD_FIELDS)
def test_a_broken_yaml_is_refused_with_its_line(tmp_path: Path, fields: dict[str, str | None], message: str) -> None:
    with pytest.raises(WorldError) as excinfo:
        load_map(write(tmp_path, **fields))
    assert message in str(excinfo.value)


BAD_PICTURES = [
    (b"", "neither PGM"),
    (b"GIF89a........", "neither PGM (P2, P5) nor PNG: it starts with b'GIF8'"),
    (b"P5", "header is broken"),
    (b"P5\n8 6\n", "header is broken"),
    (b"P5\n8 six\n255\n", "header is broken"),
    (b"P5\n-8 6\n255\n", "header is broken"),
    (b"P5\n" + b"  # c\n" * 5000 + b"x", "header is broken"),
    (b"P5\n8 6\n0\n", "largest value is 0"),
    (b"P5\n8 6\n70000\n", "largest value is 70000"),
    (b"P5\n0 6\n255\n", "0 x 6 pixels"),
    (b"P5\n99999 99999\n255\n", "99999 x 99999 pixels are more than 16,000,000"),
    (b"P5\n8 6\n255\n" + bytes(47), "cut short: it needs 48 bytes of pixels, but has 47"),
    (b"P5\n8 6\n65535\n" + bytes(95), "cut short: it needs 96 bytes"),
    (b"P5\n8 6\n100\n" + bytes([101]) * 48, "a pixel is 101, above the PGM's largest value 100"),
    (b"P2\n2 2\n255\n0 1 2", "cut short: it needs 4 pixels, but has 3"),
    (b"P2\n2 2\n255\n0 1 two 3", "'two' is not a pixel"),
    (b"P2\n2 2\n255\n0 1 -2 3", "'-2' is not a pixel"),
    (b"P2\n2 2\n255\n0 1 99999999999999 3", "is not a pixel"),
    (b"P6\n2 2\n255\n" + bytes(12), "neither PGM"),
    (b"\x89PNG\r\n\x1a\n", "the PNG is broken"),
    (png(Image.fromarray(ROOM))[:40], "the PNG is broken"),
    (png(Image.fromarray(ROOM))[:-30] + bytes(30), "the PNG is broken"),
    (png(Image.new("1", (5000, 5000))), "5000 x 5000 pixels are more than 16,000,000"),
    (pgm(np.zeros((4, 4), dtype=np.uint8)), "no cell is free"),
    (pgm(np.full((4, 4), 254, dtype=np.uint8)), "no cell is a wall"),
]


@pytest.mark.parametrize(("picture", "message"), BAD_PICTURES)
def test_a_broken_picture_is_refused_by_name(tmp_path: Path, picture: bytes, message: str) -> None:
    with pytest.raises(WorldError) as excinfo:
        load_map(write(tmp_path, picture))
    assert message in str(excinfo.value)
    assert str(tmp_path / "map.pgm") in str(excinfo.value)


def test_a_picture_of_noise_is_rejected(tmp_path: Path) -> None:
    noise = np.indices((400, 600)).sum(axis=0) % 2 * 254
    with pytest.raises(WorldError, match="an outline of 480,000 edges is not a floor plan"):
        load_map(write(tmp_path, pgm(noise.astype(np.uint8))))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "no 'key: value' lines"),
        (b"- a\n- b\n", "no 'key: value' lines"),
        (b"\xff\xfe\x00", "this is not a text file"),
        (b"image: [\n", "map.yaml:2: not YAML"),
        (b"image: map.pgm\n\tresolution: 1\n", "map.yaml:2: not YAML"),
        (b"a: \x07\n", "not YAML"),
        (b"a: " + b"[" * 20_000, "not YAML"),
        (b"a: 1\n" * 30_000, "larger than 100 kB"),
        (b"[1, 2]: 3\n", "missing"),
        (b"a: *nobody\n", "map.yaml:1: not YAML"),
        (b"a: !!python/object:os.system {}\n", "missing"),
    ],
)
def test_a_file_that_is_not_a_yaml_mapping_is_rejected(tmp_path: Path, content: bytes, message: str) -> None:
    (tmp_path / "map.yaml").write_bytes(content)
    with pytest.raises(WorldError) as excinfo:
        load_map(tmp_path / "map.yaml")
    assert message in str(excinfo.value)


def test_a_map_path_that_is_missing_or_a_folder_is_refused(tmp_path: Path) -> None:
    for path in (tmp_path / "none.yaml", tmp_path):
        with pytest.raises(WorldError, match="can't be read"):
            load_map(path)


@pytest.mark.parametrize("tolerance", [-1.0, math.nan, math.inf])
def test_an_invalid_tolerance_is_refused(tmp_path: Path, tolerance: float) -> None:
    with pytest.raises(WorldError, match="tolerance"):
        load_map(write(tmp_path), tolerance=tolerance)


def load_error(path: Path) -> str | None:
    """Load a map; return the message of the WorldError, or None for a map with walls. Anything else fails."""
    try:
        world = load_map(path)
    except WorldError as error:
        return str(error)
    assert len(world.segments) >= 4
    return None


_shared = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=150)


@pytest.mark.slow
@_shared
@given(content=st.binary(max_size=300) | st.text(max_size=300).map(str.encode))
def test_any_bytes_as_a_picture_are_a_map_or_a_world_error(tmp_path: Path, content: bytes) -> None:
    for head in (b"", b"P5\n3 3\n255\n", b"P2\n", b"\x89PNG\r\n\x1a\n"):
        message = load_error(write(tmp_path, head + content))
        assert message is None or "map.pgm" in message


@_shared
@given(
    key=st.sampled_from(sorted(FIELDS)),
    value=st.text(st.characters(exclude_categories=["Cs"]), max_size=40)
    | st.floats().map(str)
    | st.sampled_from(["~", "{}", "[]", "&a", "*a", "!x", "|", "'"]),
)
def test_any_value_of_any_field_is_a_map_or_a_world_error(tmp_path: Path, key: str, value: str) -> None:
    message = load_error(write(tmp_path, **{key: value}))
    assert message is None or str(tmp_path) in message


@_shared
@given(offset=st.integers(0, 10_000), byte=st.integers(0, 255))
def test_one_wrong_byte_in_a_png_is_a_map_or_a_world_error(tmp_path: Path, offset: int, byte: int) -> None:
    picture = bytearray(png(Image.fromarray(ROOM)))
    picture[offset % len(picture)] = byte
    message = load_error(write(tmp_path, bytes(picture), "map.png"))
    assert message is None or "map.png" in message
