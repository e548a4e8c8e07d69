"""The generated parts of the site: outputs of the chapters, links to the glossary, the table of the verification."""

from __future__ import annotations

import runpy
import subprocess
from pathlib import Path

import nbformat
import numpy as np
import pytest
from nbformat.v4 import new_code_cell, new_notebook, new_output

from autograder import course_paths
from autograder.author.course.sync import Chapter
from autograder.course_paths import Course
from sim import RobotSpec, Simulation, load_world, run

GLOSSARY = course_paths.CHAPTERS / "glossary.md"
SCRIPT = runpy.run_path(str(course_paths.ROOT / "docs" / "build_site.py"))


@pytest.mark.parametrize(("executed", "outputs"), [("1 + 1", 1), ("1 + 2", 0)])
def test_each_cell_gets_the_outputs_of_the_same_executed_cell(
    executed: str, outputs: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(course_paths, "course", lambda: Course(tmp_path, "small", "A small course"))
    chapter = Chapter(tmp_path / "10_mapping")
    reports, site = tmp_path / ".build" / "notebooks", tmp_path / "site"
    for folder in (chapter.folder, reports, site):
        folder.mkdir(parents=True)
    chapter.write(new_notebook(cells=[new_code_cell("1 + 1")]))
    output = new_output("execute_result", {"text/plain": "2"})
    report = new_notebook(cells=[new_code_cell(executed, outputs=[output])])
    nbformat.write(report, reports / "10_mapping-released.ipynb")
    SCRIPT["write_chapter"](chapter, site)
    (cell,) = nbformat.read(site / "10_mapping.ipynb", as_version=4).cells
    assert len(cell.outputs) == outputs


def test_the_first_cell_of_a_chapter_gets_its_number_and_a_link_to_the_notebook() -> None:
    text = SCRIPT["with_number"]("# A map\n\n**Why?**\n\n# Not the title", "10_mapping")
    assert text.startswith("# 10. A map\n\n{download}`Download the notebook <../notebooks/10_mapping.ipynb>`")
    assert text.endswith(".\n\n**Why?**\n\n# Not the title")


def test_the_examples_of_a_page_run_as_one_program_in_its_folder(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("```python\nn = 1\n```\n\n```text\nx\n```\n\n```python\nopen('made.txt', 'w').write(str(n))\n```\n")
    SCRIPT["run_examples"](page)
    assert (tmp_path / "made.txt").read_text() == "1"
    page.write_text("```python\nraise SystemExit(3)\n```\n")
    with pytest.raises(subprocess.CalledProcessError):
        SCRIPT["run_examples"](page)


def test_the_glossary_becomes_a_sphinx_glossary(tmp_path: Path) -> None:
    page = tmp_path / "glossary.md"
    page.write_text(
        "# Glossary\n\nQoS, quality of service\n: Whether messages may be lost.\n  Or not.\n\nNode\n: A name.\n"
    )
    assert SCRIPT["write_glossary"](page) == {"QoS", "quality of service", "Node"}
    first = "```{glossary}\nQoS\nquality of service\n  Whether messages may be lost.\n  Or not.\n```"
    assert page.read_text() == f"# Glossary\n\n{first}\n\n```{{glossary}}\nNode\n  A name.\n```\n"


def test_the_first_use_of_a_term_in_prose_is_linked_to_the_glossary() -> None:
    texts = ["# A node\n\n`node`, [a node](x.md)\n\n| node |", "Two **nodes** and a quality\nof service.", "One node."]
    assert SCRIPT["link_first_uses"](texts, {"Node", "Service", "quality of service"}) == [
        texts[0],
        "Two **{term}`nodes <Node>`** and a {term}`quality of service <quality of service>`.",
        texts[2],
    ]


def test_each_exception_from_linking_names_a_term_of_the_glossary() -> None:
    words = {word for entry in SCRIPT["ENTRY"].finditer(GLOSSARY.read_text()) for word in entry["words"].split(", ")}
    assert SCRIPT["NEVER_LINKED"].union(*SCRIPT["NOT_LINKED_ON"].values()) <= words
    assert {name for name in SCRIPT["NOT_LINKED_ON"] if name[0].isdigit()} <= set(course_paths.assignments())


@pytest.mark.promise("This robot finds its way by its lidar alone.")
def test_the_robot_on_the_start_page_hits_nothing() -> None:
    simulation = Simulation(load_world(course_paths.WORLDS / "lab.yaml"), (RobotSpec(),))
    recording = run(simulation, SCRIPT["wander"], seconds=40.0)
    hits = [event for event in recording.events if event.kind == "collision"]
    assert [event.what for event in hits if event.speed] == []  # a colleague may walk into the robot
    assert np.ptp(recording.poses[..., :2], axis=0).max() > 2.0


def test_the_table_of_the_verification_has_each_graded_chapter() -> None:
    lines = SCRIPT["verification_table"]().splitlines()
    assert sum(line.startswith("| 0") for line in lines) == 9
