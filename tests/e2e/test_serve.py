"""`autograder serve`, as a service of a hub, grades answers that students submit from the notebook."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.notebook import submit
from autograder.notebook.handing_in import SERVICE, TOKEN, Receipt
from autograder.notebook.notices import Notice
from autograder.suite import suites
from tests.unit.serve.classroom import Classroom, running_hub

CHAPTER = "01_package_structure"
SETTINGS = f"""
instructors: [grace]
assignments:
  {CHAPTER}: {{shown: visible, due: 2100-01-01 12:00}}
"""


@pytest.fixture(scope="module")
def classroom(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Classroom]:
    """The service of a real hub, with its own folder."""
    folder = tmp_path_factory.mktemp("classroom")
    (folder / "serve.yaml").write_text(SETTINGS)
    command = [sys.executable, "-c", "from autograder.cli import main; main()", "serve", str(folder / "serve.yaml")]
    with running_hub(tmp_path_factory.mktemp("hub")) as hub:
        environment = {**os.environ, **hub.environment()}
        with subprocess.Popen([*command, "--data", str(folder / "data")], env=environment) as process:
            try:
                classroom = Classroom(hub, folder)
                classroom.wait(classroom.listens)
                yield classroom
            finally:
                process.kill()


@pytest.fixture
def as_ada(classroom: Classroom, monkeypatch: pytest.MonkeyPatch) -> None:
    """Set the environment variables of ada's server."""
    monkeypatch.setenv(SERVICE, classroom.url)
    monkeypatch.setenv(TOKEN, classroom.hub.token("ada"))


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.usefixtures("as_ada")
def test_a_student_submits_from_the_notebook_and_sees_the_visible_checks(classroom: Classroom, tmp_path: Path) -> None:
    for package in suites.hidden(CHAPTER).packages:
        shutil.copytree(course_paths.SOLUTIONS / package, tmp_path / "ws" / "src" / package)
    receipt = submit(CHAPTER, tmp_path)
    assert isinstance(receipt, Receipt)
    assert f"{CHAPTER} is handed in as number {receipt.number}" in repr(receipt)
    page = f"feedback/{receipt.number}"
    classroom.wait((classroom.folder / "data" / "gradings" / f"{receipt.number:06}" / "feedback.html").exists)
    classroom.wait(lambda: "Received and graded" in classroom.get("ada", page)[1])
    html = classroom.get("ada", page)[1]
    assert html.count('class="check passed"') == len(suites.visible(CHAPTER).checks)
    assert "points" not in html.partition("Visible checks")[2]
    assert "points, 100 %" in classroom.get("grace", page)[1]


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_an_invalid_submission_is_unclear_and_its_markup_is_not_shown(classroom: Classroom) -> None:
    number = classroom.hand_in("bob", b"<script>alert(1)</script>", assignment=CHAPTER).number
    classroom.wait((classroom.folder / "data" / "gradings" / f"{number:06}" / "feedback.html").exists)
    classroom.wait(lambda: "unclear" in classroom.get("bob")[1])
    for user in ("bob", "grace"):
        assert "<script>alert" not in classroom.get(user, f"feedback/{number}")[1]
    assert "Unclear" in classroom.get("grace", f"feedback/{number}")[1]


@pytest.mark.usefixtures("as_ada")
def test_a_folder_without_an_answer_is_not_submitted(classroom: Classroom, tmp_path: Path) -> None:
    before = classroom.get("ada")[1].count("feedback/")
    notice = submit(CHAPTER, tmp_path)
    assert isinstance(notice, Notice)
    assert notice.sentence == "Nothing was handed in."
    assert classroom.get("ada")[1].count("feedback/") == before
