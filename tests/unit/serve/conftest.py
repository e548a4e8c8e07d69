"""A real JupyterHub, and the service behind it, as fixtures."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.notebook import handing_in
from tests.unit.serve.classroom import Classroom, Hub, running_hub


@pytest.fixture(scope="session")
def hub(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hub]:
    """A real JupyterHub."""
    with running_hub(tmp_path_factory.mktemp("hub")) as hub:
        yield hub


@pytest.fixture
def classroom(hub: Hub, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Classroom]:
    """The hub's service on an empty folder, not yet started. Clients retry at once if it does not answer."""
    monkeypatch.setattr(handing_in, "PAUSES", (0.05,) * 400)
    classroom = Classroom(hub, tmp_path)
    yield classroom
    if classroom.process is not None and classroom.process.is_alive():
        classroom.kill()
