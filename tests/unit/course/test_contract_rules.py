"""Each requirement is in the cell that names it and has a check, and each check has a requirement."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from nbformat import NotebookNode

from autograder.author.course.contract_rules import cells_findings, coverage_findings
from autograder.author.course.findings import Finding
from autograder.author.course.sync import chapters
from autograder.suite import Check, Visibility, suites
from autograder.suite.contract import contract, requirements

from .notebooks import code, notebook, prose, solution

TABLE = """The node is called `guard`.

| what it knows | speed | turn |
|---|---|---|
| no scan yet | 0 | 0 |

- It ends with
  exit status 0."""
ROW, ENDS = "| no scan yet | 0 | 0 |", "- It ends with exit status 0."
FUNCTION = '%%writefile ws/a.py\ndef main():\n    """Run."""\n'
UNNAMED = (
    "neither `contract` nor `explains` names a sentence of {!r}: give it an id in `contract`, or quote it in "
    "`explains` if it requires nothing"
)
MAX_UNCHECKED = 12  # in the whole course


def contract_notebook(**course: Any) -> NotebookNode:
    return notebook(prose(TABLE, "table", course={"contract": {"waits": ROW, "ends": ENDS}, **course}))


def check(id: str, *covers: str) -> Check:
    return Check(id, f"{id}.", 1.0, "graph", Visibility.HIDDEN, (), None, (), covers)


def broken(name: str, notebook: NotebookNode, checks: Sequence[Check]) -> list[Finding]:
    return [*cells_findings(name, notebook), *coverage_findings(name, notebook, checks, {})]


def messages(notebook: NotebookNode, *checks: Check) -> list[str]:
    return [finding.message for finding in broken("small.ipynb", notebook, checks)]


def test_a_table_row_is_quoted_with_its_heading_and_a_bullet_without_its_dash() -> None:
    stated = requirements(contract_notebook().cells)
    assert stated["waits"].text == "no scan yet: speed 0, turn 0"
    assert stated["ends"].text == "It ends with exit status 0."


def test_a_complete_contract_has_no_findings() -> None:
    assert messages(contract_notebook(), check("stops", "waits", "ends")) == []


def test_a_requirement_without_a_check_is_found() -> None:
    assert messages(contract_notebook(), check("stops", "waits")) == ["no check covers the requirement 'ends'"]


def test_a_check_without_a_requirement_is_found() -> None:
    findings = messages(contract_notebook(), check("stops", "waits", "ends"), check("bare"), check("other", "flies"))
    assert findings == [
        "the hidden check 'bare' covers no requirement",
        "the hidden check 'other' covers 'flies', which no cell names: the known names are waits, ends",
    ]


def test_a_sentence_that_changed_in_its_cell_is_found() -> None:
    notebook = contract_notebook(contract={"waits": ROW.replace("0", "1"), "ends": ENDS})
    findings = messages(notebook, check("stops", "waits", "ends"))
    assert "'waits': its released text does not contain the sentence '| no scan yet | 1 | 1 |'" in findings


def test_a_text_that_differs_from_the_released_one_is_found() -> None:
    findings = messages(
        contract_notebook(contract={"waits": ROW, "ends": ENDS, "name": "called `guard"}),
        check("s", "waits", "ends", "name"),
    )
    assert findings == ["'name': 'called `guard' is not a row, a sentence or part of one in the released text"]


def test_a_row_or_a_bullet_without_an_id_is_found_unless_it_only_explains() -> None:
    incomplete = {"contract": {"waits": ROW}}
    assert messages(contract_notebook(**incomplete), check("stops", "waits")) == [UNNAMED.format(ENDS)]
    assert messages(contract_notebook(**incomplete, explains=["exit status 0."]), check("stops", "waits")) == []


def test_a_cell_that_only_explains_names_each_row_and_bullet() -> None:
    assert messages(notebook(prose(TABLE, "table", course={"explains": [ROW]}))) == [UNNAMED.format(ENDS)]
    assert messages(notebook(prose(TABLE, "table", course={"explains": [ROW, ENDS]}))) == []


def test_a_cell_that_an_objective_names_as_its_exercise_names_each_row_and_bullet() -> None:
    cells = [prose("- A bullet.", name) for name in ("before", "exercise")]
    objective = {"objective": "guard", "exercise": "exercise", "groups": ["graph"]}
    findings = broken("small.ipynb", notebook(*cells, objectives=[objective]), ())
    assert [(finding.cell, finding.message) for finding in findings] == [("exercise", UNNAMED.format("- A bullet."))]
    assert messages(notebook(*cells)) == []


def test_a_sentence_that_the_release_does_not_show_is_found() -> None:
    source = f"{FUNCTION}    # BEGIN SOLUTION\n    end()  # It ends.\n    # END SOLUTION"
    course = {"hide": ["main"], "contract": {"runs": "Run.", "ends": "It ends."}}
    nb = notebook(code(source, "main", course=course, nbgrader=solution("main")))
    findings = messages(nb, check("stops", "runs", "ends"))
    assert findings == ["'ends': its released text does not contain the sentence 'It ends.'"]


def test_the_docstring_of_a_function_that_a_student_writes_needs_an_id() -> None:
    source = f"{FUNCTION}    # BEGIN SOLUTION\n    pass\n    # END SOLUTION"
    nb = notebook(code(source, "main", course={"hide": ["main"]}, nbgrader=solution("main")))
    assert messages(nb) == [UNNAMED.format("Run.")]


def test_an_unchecked_sentence_has_no_check() -> None:
    notebook = contract_notebook(unchecked={"ends": "it is not visible from outside"})
    assert messages(notebook, check("stops", "waits")) == []
    findings = messages(notebook, check("stops", "waits", "ends"))
    assert findings == ["the requirement 'ends' is marked as unchecked, but a check covers it"]
    assert "'flies' is marked as unchecked, but is not a requirement of the cell" in messages(
        contract_notebook(unchecked={"flies": "so"}), check("stops", "waits", "ends")
    )


@pytest.mark.parametrize("chapter", chapters(), ids=lambda chapter: chapter.assignment)
def test_the_contract_of_each_chapter_has_no_findings(chapter: Any) -> None:
    name = chapter.assignment
    hidden = suites.hidden(name).checks if name in suites.graded_assignments() else ()
    assert [
        str(f) for f in broken(chapter.notebook_path.name, chapter.read(), (*suites.visible(name).checks, *hidden))
    ] == []


def test_the_course_has_no_more_unchecked_sentences_than_allowed() -> None:
    findings = [s.id for name in suites.checkable_assignments() for s in contract(name).values() if s.unchecked]
    assert len(findings) <= MAX_UNCHECKED, findings
