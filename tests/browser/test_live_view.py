"""The live view as a student uses it: JupyterLab in a real browser, a notebook's cells, the buttons."""

from __future__ import annotations

import io
import json
import os
import secrets
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import nbformat
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.browser

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 120.0  # seconds: a deadline, not an expectation

DRIVE = """
from pathlib import Path
from sim import Command, RobotSpec, Simulation, load_world
from sim.view import live
world = load_world({world!r})
def drive(scan):
    return Command(linear=0.3, angular=0.4)
view = live(Simulation(world), drive)
view
"""

BREAK = """
def broken(scan):
    return Command(linear=1.0 / 0.0)
live(world, broken)
"""


@dataclass(frozen=True)
class Lab:
    """A running JupyterLab: its address, its token, and the folder it serves."""

    url: str
    token: str
    folder: Path

    def open(self, page: Page, name: str, cells: list[str]) -> None:
        """Write a notebook of code cells, open it alone in the page and run all its cells."""
        notebook = nbformat.v4.new_notebook(
            cells=[nbformat.v4.new_code_cell(cell.strip()) for cell in cells],
            metadata={"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}},
        )
        nbformat.write(notebook, self.folder / name)
        page.set_default_timeout(PATIENCE * 1000)
        page.goto(f"{self.url}/doc/tree/{name}?token={self.token}")
        expect(page.locator(".jp-Notebook")).to_be_visible(timeout=PATIENCE * 1000)
        page.evaluate("""async () => {
            await window.jupyterapp.restored;
            const panel = window.jupyterapp.shell.currentWidget;
            await panel.context.ready;
            await panel.sessionContext.ready;
            await panel.sessionContext.session.kernel.info;
            window.jupyterapp.commands.execute("notebook:run-all-cells");
        }""")


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    """A JupyterLab of its own on loopback, with a token, a port and settings of its own."""
    home = tmp_path_factory.mktemp("jupyter")
    folder = home / "notebooks"
    folder.mkdir()
    settings = home / "config" / "labconfig" / "page_config.json"
    settings.parent.mkdir(parents=True)
    settings.write_text(json.dumps({"disabledExtensions": {"@jupyterlab/apputils-extension:announcements": True}}))
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    token = secrets.token_hex(16)
    environment = {
        **{key: value for key, value in os.environ.items() if key != "AUTOGRADER_GRADING"},
        "HOME": str(home),
        "JUPYTER_CONFIG_DIR": str(home / "config"),
        "JUPYTER_DATA_DIR": str(home / "data"),
        "JUPYTER_RUNTIME_DIR": str(home / "runtime"),
        "IPYTHONDIR": str(home / "ipython"),
        "PYTHONPATH": str(ROOT),
    }
    command = [
        *(sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root"),
        *("--ServerApp.ip=127.0.0.1", f"--ServerApp.port={port}", "--ServerApp.port_retries=0"),
        *(f"--IdentityProvider.token={token}", f"--ServerApp.root_dir={folder}"),
        *("--LabApp.expose_app_in_browser=True", "--LabApp.extension_manager=readonly"),
        "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate",
    ]
    with (home / "log").open("wb") as log:
        server = subprocess.Popen(command, env=environment, stdout=log, stderr=log)
        try:
            url = f"http://127.0.0.1:{port}"
            _wait_for_server(server, f"{url}/api/status?token={token}", home / "log")
            yield Lab(url, token, folder)
        finally:
            server.terminate()
            try:
                server.wait(timeout=30)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()


def _wait_for_server(server: subprocess.Popen[bytes], url: str, log: Path) -> None:
    deadline = time.monotonic() + PATIENCE
    pause = threading.Event()
    while time.monotonic() < deadline and server.poll() is None:
        try:
            with urllib.request.urlopen(url, timeout=5) as answer:
                assert "kernels" in json.load(answer)
                return
        except (urllib.error.URLError, OSError):
            pause.wait(0.2)
    pytest.fail(f"JupyterLab did not start:\n{log.read_text()}")


def pixels(image: Locator) -> Any:
    """The part of the live image that shows the world, without the clock above it, as (H, W, 3) numbers."""
    picture = np.asarray(Image.open(io.BytesIO(image.screenshot())).convert("RGB"), dtype=np.int16)
    height, width, _ = picture.shape
    return picture[int(0.1 * height) :, : int(0.62 * width)]


def changed(before: Any, after: Any) -> int:
    """How many pixels are clearly not what they were."""
    return int((np.abs(before - after).max(axis=2) > 60).sum())


def wait_until_moved(image: Locator, before: Any, least: int = 40) -> int:
    """Wait until the world's picture differs from `before`; return by how many pixels."""
    deadline, difference = time.monotonic() + PATIENCE, 0
    while time.monotonic() < deadline:
        difference = changed(before, pixels(image))
        if difference >= least:
            return difference
    pytest.fail(f"the picture did not change: {difference} pixels")


def wait_until_still(page: Page, image: Locator) -> None:
    """Wait until the image has been the same one for five looks in a row."""
    page.wait_for_function(
        """image => {
            image.looks = image.src === image.last ? (image.looks || 0) + 1 : 0;
            image.last = image.src;
            return image.looks >= 5;
        }""",
        arg=image.element_handle(),
        polling=200,
        timeout=PATIENCE * 1000,
    )


def test_the_robot_moves_pauses_and_obeys_the_pad(page: Page, lab: Lab, screenshots: Path) -> None:
    lab.open(page, "drive.ipynb", [DRIVE.format(world=str(ROOT / "assets/worlds/lab.yaml"))])
    image = page.locator(".jp-OutputArea-output img").first
    expect(image).to_be_visible(timeout=PATIENCE * 1000)
    wait_until_moved(image, pixels(image))
    page.screenshot(path=screenshots / "live-view-playing.png")

    page.get_by_title("Pause", exact=True).click()
    expect(page.get_by_title("Play", exact=True)).to_be_visible(timeout=PATIENCE * 1000)
    wait_until_still(page, image)
    paused = pixels(image)
    assert changed(paused, pixels(image)) == 0

    page.get_by_title("Forward", exact=True).click()
    expect(page.get_by_text("+0.22 m/s +0.00 rad/s")).to_be_visible(timeout=PATIENCE * 1000)
    for _ in range(5):
        page.get_by_title("One step of 0.1 s").click()
    wait_until_moved(image, paused, least=10)
    page.screenshot(path=screenshots / "live-view-pad.png")

    page.get_by_title("Back to the start").click()
    wait_until_moved(image, paused)
    wait_until_still(page, image)
    start = pixels(image)
    page.get_by_title("Play", exact=True).click()
    wait_until_moved(image, start)


def test_an_error_of_the_callback_is_shown_in_the_cell(page: Page, lab: Lab, screenshots: Path) -> None:
    first = DRIVE.format(world=str(ROOT / "assets/worlds/empty_room.yaml")).replace("\nview\n", "\nview.pause()\n")
    lab.open(page, "break.ipynb", [first, BREAK])
    error = page.get_by_text("ZeroDivisionError: float division by zero").first
    expect(error).to_be_visible(timeout=PATIENCE * 1000)
    expect(page.get_by_text("in broken")).to_be_visible()
    expect(page.get_by_title("Play", exact=True)).to_be_visible()
    page.screenshot(path=screenshots / "live-view-error.png")


def test_a_static_picture_stands_in_the_notebook_with_its_alternative_text(
    page: Page, lab: Lab, screenshots: Path
) -> None:
    world = str(ROOT / "assets/worlds/maze.yaml")
    lab.open(
        page, "show.ipynb", [f"from sim import load_world\nfrom sim.view import show\nshow(load_world({world!r}))"]
    )
    picture = page.get_by_alt_text("Map of the world “maze”", exact=False)
    expect(picture).to_be_visible(timeout=PATIENCE * 1000)
    assert picture.evaluate("image => image.naturalWidth") > 500
    page.screenshot(path=screenshots / "show-world.png")
