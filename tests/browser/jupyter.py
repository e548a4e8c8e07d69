"""A separate JupyterLab, opened in a browser page."""

from __future__ import annotations

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
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import nbformat
import pytest
from playwright.sync_api import Page, expect

ROOT = Path(__file__).resolve().parents[2]
STUDENTS_SETTINGS = ROOT / "assets" / "students" / "jupyter"
PATIENCE = 120.0  # seconds: a deadline, not an expectation


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
        self.show(page, name)
        self.run_all(page)

    def show(self, page: Page, path: str) -> None:
        """Open a notebook of the folder alone in the page, and wait until its kernel answers."""
        page.set_default_timeout(PATIENCE * 1000)
        page.goto(f"{self.url}/doc/tree/{path}?token={self.token}")
        expect(page.locator(".jp-Notebook")).to_be_visible(timeout=PATIENCE * 1000)
        page.evaluate("""async () => {
            await window.jupyterapp.restored;
            const panel = window.jupyterapp.shell.currentWidget;
            await panel.context.ready;
            await panel.sessionContext.ready;
            await panel.sessionContext.session.kernel.info;
        }""")

    def run_all(self, page: Page) -> None:
        """Start to run all cells of the notebook in the page."""
        page.evaluate("() => { window.jupyterapp.commands.execute('notebook:run-all-cells'); }")


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    """A separate JupyterLab on loopback, with its own token, port and settings."""
    home = tmp_path_factory.mktemp("jupyter")
    folder = home / "notebooks"
    folder.mkdir()
    settings = home / "config" / "labconfig" / "page_config.json"
    settings.parent.mkdir(parents=True)
    settings.write_text(json.dumps({"disabledExtensions": {"@jupyterlab/apputils-extension:announcements": True}}))
    options = ["--LabApp.expose_app_in_browser=True", "--LabApp.extension_manager=readonly"]
    options += ["--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate"]
    with serving("jupyterlab", home, folder, *options) as lab:
        yield lab


@contextmanager
def serving(module: str, home: Path, folder: Path, *options: str) -> Iterator[Lab]:
    """Start a Jupyter server in a folder, with a separate home."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    token = secrets.token_hex(16)
    environment = {
        **{key: value for key, value in os.environ.items() if key != "AUTOGRADER_GRADING"},
        "HOME": str(home),
        "JUPYTER_CONFIG_DIR": str(home / "config"),
        "JUPYTER_CONFIG_PATH": str(STUDENTS_SETTINGS),
        "JUPYTER_DATA_DIR": str(home / "data"),
        "JUPYTER_RUNTIME_DIR": str(home / "runtime"),
        "IPYTHONDIR": str(home / "ipython"),
        "PYTHONPATH": str(ROOT),
    }
    command = [
        *(sys.executable, "-m", module, "--no-browser", "--allow-root"),
        *("--ServerApp.ip=127.0.0.1", f"--ServerApp.port={port}", "--ServerApp.port_retries=0"),
        *(f"--IdentityProvider.token={token}", f"--ServerApp.root_dir={folder}", *options),
    ]
    with (home / "log").open("wb") as log:
        server = subprocess.Popen(command, cwd=folder, env=environment, stdout=log, stderr=log)
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
    pytest.fail(f"Jupyter did not start:\n{log.read_text()}")
