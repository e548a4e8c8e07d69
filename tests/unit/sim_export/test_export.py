"""A recording as GIF, HTML and rosbag2: read back by other libraries than those that wrote them."""

from __future__ import annotations

import hashlib
import json
import math
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from autograder.ros.distribution import DISTRIBUTION
from sim import Recording, SimError, World, run
from sim.export import ExportError, export, to_gif, to_html, to_mcap, to_mp4
from sim.simulation import Simulation


def test_a_gif_has_a_frame_for_each_tenth_of_a_second(recording: Recording, tmp_path: Path) -> None:
    with Image.open(to_gif(recording, tmp_path / "run.gif")) as image:
        assert image.format == "GIF"
        assert image.n_frames == 31
        assert image.info["duration"] == 100
        first = np.asarray(image.convert("RGB"))
        image.seek(30)
        assert (first != np.asarray(image.convert("RGB"))).any()


def test_a_fast_gif_has_fewer_frames(recording: Recording, tmp_path: Path) -> None:
    with Image.open(to_gif(recording, tmp_path / "run.gif", speed=3.0, fps=5.0)) as image:
        assert image.n_frames == 6


@pytest.mark.parametrize(("speed", "fps"), [(0.0, 10.0), (1.0, 0.0), (math.nan, 10.0), (1.0, 100.0)])
def test_an_invalid_gif_setting_is_refused(recording: Recording, tmp_path: Path, speed: float, fps: float) -> None:
    with pytest.raises(ExportError, match="makes no sense"):
        to_gif(recording, tmp_path / "run.gif", speed=speed, fps=fps)


def test_an_endless_gif_is_refused(recording: Recording, tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="3001 frames are too many for a GIF: raise 'speed', or lower 'fps'"):
        to_gif(recording, tmp_path / "run.gif", speed=0.01)


def test_a_video_without_ffmpeg_says_what_to_do(
    recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ExportError, match=r"needs the program ffmpeg: install it, or export a \.gif or \.html"):
        to_mp4(recording, tmp_path / "run.mp4")
    with pytest.raises(ExportError, match="makes no sense"):
        to_mp4(recording, tmp_path / "run.mp4", speed=0.0)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="no ffmpeg on this machine")
def test_a_video_has_a_frame_for_each_of_its_instants(recording: Recording, tmp_path: Path) -> None:
    path = to_mp4(recording, tmp_path / "run.mp4", speed=2.0, fps=10.0)
    command = ["ffmpeg", "-loglevel", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "gray", "-"]
    decoded = subprocess.run(command, capture_output=True, check=True).stdout
    frames = 1 + int((recording.times[-1] - recording.times[0]) / 2.0 * 10.0)
    assert len(decoded) % frames == 0
    first_frame, last_frame = decoded[: len(decoded) // frames], decoded[-len(decoded) // frames :]
    assert sum(abs(before - after) > 60 for before, after in zip(first_frame, last_frame, strict=True)) > 100
    with pytest.raises(ExportError, match="ffmpeg ended with status"):
        to_mp4(recording, tmp_path / "an-ending.nobody-knows")


class _Page(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))


def test_a_page_contains_the_run_and_loads_nothing(recording: Recording, tmp_path: Path) -> None:
    text = to_html(recording, tmp_path / "run.html").read_text(encoding="utf-8")
    page = _Page(text)
    addresses = [attrs[name] or "" for _, attrs in page.tags for name in ("src", "href") if name in attrs]
    assert [address[:22] for address in addresses] == ["data:image/png;base64,"]  # the picture without scripts
    assert not re.search(r"url\(|@import|https?://(?!www\.w3\.org/2000/svg)", text)
    stored = re.search(r'<script type="application/json">(.*?)</script>', text, re.DOTALL)
    assert stored is not None
    data = json.loads(stored.group(1))
    assert "Track of one" in data["alt"]
    assert [robot["name"] for robot in data["robots"]] == ["one", "two"]


def test_a_name_cannot_break_out_of_the_page(tmp_path: Path) -> None:
    markup = '</script><script>alert(1)</script>"&'
    recording = run(Simulation(World(name=markup)), lambda state, scans: None, 0.5)
    text = to_html(recording, tmp_path / "run.html").read_text(encoding="utf-8")
    assert "alert(1)</script>" not in text
    assert len([tag for tag, _ in _Page(text).tags if tag == "script"]) == 2


def test_a_bag_contains_every_message_in_order_of_time(recording: Recording, tmp_path: Path) -> None:
    folder = to_mcap(recording, tmp_path / "run.mcap")
    assert folder == tmp_path / "run"
    store = get_typestore(Stores[f"ROS2_{DISTRIBUTION.name.upper()}"])
    with AnyReader([folder], default_typestore=store) as reader:
        counts = {connection.topic: connection.msgcount for connection in reader.connections}
        messages = [
            (connection.topic, time, reader.deserialize(data, connection.msgtype))
            for connection, time, data in reader.messages()
        ]
    rows, scans = len(recording), len(recording.scans[0].rows)
    topics = {"/clock": rows, "/cmd_vel": rows - 1, "/odom": rows, "/scan": scans}
    topics |= {"/two/cmd_vel": rows - 1, "/two/odom": rows, "/two/scan": len(recording.scans[1].rows)}
    assert counts == topics
    times = [time for _, time, _ in messages]
    assert times == sorted(times)

    last_scan = [message for topic, _, message in messages if topic == "/scan"][-1]
    assert last_scan.ranges.tobytes() == recording.scans[0].ranges[-1].tobytes()
    assert last_scan.header.frame_id == "laser"
    last_odometry = [message for topic, _, message in messages if topic == "/odom"][-1]
    assert last_odometry.pose.pose.position.x == recording.odometry[-1, 0, 0]
    assert last_odometry.pose.covariance.reshape(6, 6)[5, 5] == recording.covariances[-1, 0, 8] > 0.0
    other = [message for topic, _, message in messages if topic == "/two/odom"][-1]
    assert (other.header.frame_id, other.child_frame_id) == ("two/odom", "two/base_link")
    commands = [message for topic, _, message in messages if topic == "/cmd_vel"]
    assert {(command.linear.x, command.angular.z) for command in commands} == {(0.3, 0.2)}


def test_an_existing_bag_is_not_overwritten(recording: Recording, tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    with pytest.raises(ExportError, match="run: it already exists"):
        to_mcap(recording, tmp_path / "run.mcap")


def test_without_rosbags_the_message_says_what_to_install(
    recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "rosbags.interfaces", None)
    with pytest.raises(ExportError, match=r"pip install 'ros2-python-course\[export\]'"):
        to_mcap(recording, tmp_path / "run.mcap")


def test_the_ending_of_the_file_name_selects_the_format(recording: Recording, tmp_path: Path) -> None:
    assert export(recording, tmp_path / "a" / "run.html").is_file()
    assert (export(recording, tmp_path / "b" / "run.mcap") / "metadata.yaml").is_file()
    assert export(recording, tmp_path / "c" / "run.gif").is_file()
    with Image.open(export(recording, tmp_path / "d" / "run.gif", speed=3.0)) as image:
        assert image.n_frames < 12
    with pytest.raises(ExportError, match=r"only a \.gif or \.mp4 has fps and speed: leave it out"):
        export(recording, tmp_path / "run.html", speed=2.0, fps=5.0)
    for name in ("run.avi", "run"):
        with pytest.raises(ExportError, match=r"use \.gif, \.mp4, \.html or \.mcap"):
            export(recording, tmp_path / name)
    assert issubclass(ExportError, SimError)


@pytest.mark.parametrize("suffix", ["gif", "html", "mcap"])
def test_the_same_run_gives_the_same_bytes(recording: Recording, tmp_path: Path, suffix: str) -> None:
    hashes = set()
    for folder in ("first", "second"):
        path = export(recording, tmp_path / folder / f"run.{suffix}")
        file = path if path.is_file() else path / f"{path.name}.mcap"
        hashes.add(hashlib.sha256(file.read_bytes()).hexdigest())
    assert len(hashes) == 1
