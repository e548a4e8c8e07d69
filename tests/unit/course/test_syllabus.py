"""Each item of the syllabus is found in the notebooks, or named as missing."""

from __future__ import annotations

import pytest

from autograder import course_paths
from autograder.author.course.syllabus import Location, Syllabus, find_coverage
from autograder.author.course.tables import course_page, page
from autograder.author.course.workload import Effort
from autograder.suite import Check, Visibility

from .notebooks import code, notebook, prose

SYLLABUS = Syllabus(
    {"nodes": "Write nodes"}, {"basic_node.py": "BasicNode", "Q1": "What is setup.py?"}, {7: ("no", "yes")}
)
CHECK = Check("named", "It has its name.", 2.0, "graph", Visibility.HIDDEN, (), None, ())
OBJECTIVE = {"objective": "nodes", "exercise": "exercise", "groups": ["graph"]}


def chapter_notebook(**course: object):  # type: ignore[no-untyped-def]
    cells = (prose("# From a node to a robot", "title"), prose("## Write it", "exercise"), code("1", "node"))
    cells[2].metadata["course"] = {"covers": ["basic_node.py"], "errata": [7]}
    return notebook(*cells, **course)


def messages(*chapters: object) -> list[str]:
    return [finding.message for finding in find_coverage(SYLLABUS, chapters).findings]  # type: ignore[arg-type]


def test_a_location_is_named_by_the_heading_above_it() -> None:
    coverage = find_coverage(SYLLABUS, [("02_nodes", chapter_notebook(objectives=[OBJECTIVE]), [CHECK])])
    assert coverage.items == {"basic_node.py": [Location("02_nodes", "Write it")], "Q1": []}
    assert coverage.errata == {7: [Location("02_nodes", "Write it")]}
    assert [(row.exercise, row.checks) for row in coverage.rows] == [("Write it", (CHECK,))]


def test_a_syllabus_item_that_no_notebook_covers_is_named() -> None:
    assert messages(("02_nodes", chapter_notebook(objectives=[OBJECTIVE]), [CHECK])) == [
        "no notebook covers 'Q1': What is setup.py?"
    ]
    assert "no hidden check covers 'nodes': Write nodes" in messages(("02_nodes", chapter_notebook(), []))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"objective": "flying"}, "the syllabus has no objective 'flying'"),
        ({"exercise": "gone"}, "the notebook has no cell 'gone'"),
        ({"groups": ["graph", "wings"]}, "the suite has no group wings"),
        ({"groups": []}, "no objective names the groups graph"),
    ],
)
def test_an_objective_with_an_unknown_or_missing_target_is_named(change: dict[str, object], message: str) -> None:
    assert message in messages(("02_nodes", chapter_notebook(objectives=[{**OBJECTIVE, **change}]), [CHECK]))


def test_a_key_that_the_syllabus_does_not_have_is_named() -> None:
    notebook = chapter_notebook(objectives=[OBJECTIVE], errata=[99])
    assert "the syllabus has no 99" in messages(("02_nodes", notebook, [CHECK]))


def test_the_page_has_a_row_for_each_item_and_escapes_markdown() -> None:
    coverage = find_coverage(SYLLABUS, [("02_nodes", chapter_notebook(objectives=[OBJECTIVE]), [CHECK])])
    text = page(SYLLABUS, coverage, {"02_nodes": "A | B"}, {"02_nodes": Effort(words=240, cells=10, lines=100)})
    assert "| [02_nodes](02_nodes/02_nodes.ipynb) | A \\| B | 2 | 240 | 10 | 100 | 2 hours |" in text
    assert "| Write nodes | 02_nodes | Write it | `named` |" in text
    assert "| 7 | no | yes | 02_nodes: Write it |" in text


@pytest.mark.promise("`chapters/README.md` in the repository lists the objectives of each chapter")
def test_the_course_covers_the_syllabus_and_its_page_is_up_to_date() -> None:
    written, findings = course_page()
    assert [str(finding) for finding in findings] == []
    page = (course_paths.CHAPTERS / "README.md").read_text(encoding="utf-8")
    assert page == written, "it is out of date: run `autograder course tables`"


def test_the_syllabus_names_all_items_of_the_textbook_chapter() -> None:
    syllabus = Syllabus.read()
    objectives = {"structure", "nodes", "client-library", "interfaces", "build-and-test", "best-practices"}
    assert objectives <= set(syllabus.objectives)
    assert set(syllabus.errata) == set(range(1, 49))
    assert {f"step-{n}" for n in range(1, 8)} | {"Q1", "Q2", "Q3"} <= set(syllabus.items)
