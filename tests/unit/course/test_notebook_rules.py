"""A committed notebook has no outputs, is valid for nbgrader, and can be read by everyone."""

from __future__ import annotations

import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_output

from autograder.author.course.notebook_rules import rules_findings
from tests.notebooks.alternative_texts import images_without_alt

from .notebooks import code, grade, manual, notebook, prose, solution


def messages(notebook: NotebookNode) -> str:
    return "\n".join(str(finding) for finding in rules_findings("n.ipynb", notebook))


def test_a_clean_notebook_has_no_findings() -> None:
    nb = notebook(
        prose("# Title\n\n## Part\n\n### Step\n\n![a robot](robot.png)\n\n```\n# no heading\n```", "title"),
        prose("## Next\n\n<img src='x.svg' alt='a wall'>", "next"),
        code("# BEGIN SOLUTION\n# END SOLUTION", "s", nbgrader=solution("s")),
        code("grade()", "g", nbgrader=grade("g", 1), course={"group": "graph"}),
    )
    assert messages(nb) == ""


ANSWER = "# BEGIN SOLUTION\nSo.\n# END SOLUTION"
SCHEME = "### BEGIN MARK SCHEME\n1 point.\n### END MARK SCHEME"


def test_cells_that_a_person_grades_need_no_group_and_their_markers_are_not_headings() -> None:
    nb = notebook(
        prose("# Title", "title"),
        prose(f"Why?\n\n{SCHEME}", "why", nbgrader={**solution("why"), "solution": False, "locked": True}),
        prose(ANSWER, "so", nbgrader=manual("so", 2)),
    )
    assert messages(nb) == ""


def executed() -> NotebookNode:
    cell = code("1", "run")
    cell.execution_count = 1
    cell.outputs = [new_output("execute_result", {"text/plain": "1"}, execution_count=1)]
    return notebook(prose("# T", "t"), cell)


def old_schema() -> NotebookNode:
    return notebook(prose("# T", "t"), code("", "g", nbgrader={**grade("g", 1), "schema_version": 2}))


def half_a_cell() -> NotebookNode:
    nb = notebook(code("", "half"))
    del nb.cells[0]["source"]
    return nb


def other_kernel() -> NotebookNode:
    nb = notebook(prose("# T", "t"))
    nb.metadata.kernelspec.name = "ros"
    return nb


def old_format() -> NotebookNode:
    nb = notebook(prose("# T", "t"))
    nb.nbformat_minor = 4
    del nb.cells[0]["id"]
    return nb


@pytest.mark.parametrize(
    ("nb", "message"),
    [
        (executed(), "cell 'run': has outputs"),
        (executed(), "cell 'run': has an execution count"),
        (old_schema(), "cell 'g': its nbgrader metadata must have schema_version 3"),
        (other_kernel(), "kernelspec must be python3"),
        (old_format(), "is nbformat 4.4; the course uses 4.5"),
        (notebook(prose("text", "t")), "has no title"),
        (notebook(prose("## Part", "p")), "cell 'p': the first heading of a notebook must be its title"),
        (notebook(prose("# T", "t"), prose("# U", "u")), "cell 'u': a notebook must have only one title"),
        (notebook(prose("# T\n### U", "t")), "a heading of level 3 follows one of level 1"),
        (notebook(prose("# T\n![](robot.png)", "t")), "the image robot.png has no alternative text"),
        (
            notebook(prose("# T\n<img src='x.svg' alt=''>", "t")),
            "the image <img src='x.svg' alt=''> has no alternative",
        ),
        (
            notebook(prose("# T", "t"), code("", "g", nbgrader=grade("g", 1))),
            "cell 'g': a grade cell must be locked and name its group",
        ),
        (
            notebook(prose("# T", "t"), code("", "g", nbgrader=grade("g", 1), course={"group": 3})),
            "cell 'g': the metadata are invalid: `group` must be a string, not a number",
        ),
        (
            notebook(prose("# T", "t"), code("# BEGIN SOLUTION", "s")),
            "cell 's': contains a solution but is not marked",
        ),
        (
            notebook(*(code("", i, nbgrader=grade("same", 1)) for i in "ab")),
            "its nbgrader metadata are invalid: Duplicate grade id: same",
        ),
        (half_a_cell(), "is not valid nbformat"),
        (
            notebook(prose("# T", "t"), prose(ANSWER, "m", nbgrader={**manual("m", 1), "locked": True})),
            "cell 'm': is locked, but students must write in it: unlock it",
        ),
        (
            notebook(prose("# T", "t"), prose(ANSWER, "m", nbgrader=manual("m", 0))),
            "cell 'm': a manually graded cell needs points above 0",
        ),
        (
            notebook(prose("# T", "t"), prose(ANSWER, "m", nbgrader=manual("m", 1), course={"group": "graph"})),
            "is manually graded and cannot also belong to the group 'graph' of checks",
        ),
        (
            notebook(prose("# T", "t"), prose("So.", "m", nbgrader=manual("m", 1))),
            "cell 'm': a manually graded cell needs a model answer between the solution markers",
        ),
        (
            notebook(prose("# T", "t"), prose(SCHEME, "s")),
            "cell 's': contains a mark scheme but is not locked",
        ),
    ],
)
def test_each_error_of_a_notebook_is_named(nb: NotebookNode, message: str) -> None:
    assert message in messages(nb)


@pytest.mark.parametrize(
    ("data", "metadata", "is_found"),
    [
        ({"text/plain": "1"}, {}, False),
        ({"image/png": "..."}, {}, True),
        ({"image/png": "..."}, {"image/png": {"alt": "a track"}}, False),
        ({"text/html": "<img src='x'>"}, {}, True),
        ({"text/html": "<img alt='a track' src='x'>", "image/png": "..."}, {}, False),
    ],
)
def test_a_figure_without_alternative_text_is_found(
    data: dict[str, str], metadata: dict[str, object], is_found: bool
) -> None:
    cell = code("show()", "figure")
    cell.outputs = [new_output("display_data", data, metadata=metadata)]
    assert images_without_alt(notebook(cell)) == (["figure"] if is_found else [])
