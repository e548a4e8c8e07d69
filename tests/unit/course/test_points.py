"""Grade cells, groups and points are consistent."""

from __future__ import annotations

import pytest
from nbformat import NotebookNode

from autograder.author.course.points import point_differences

from .notebooks import code, grade, manual, notebook, prose

POINTS = {"reaction": 3.5, "graph": 1.0}


def graded(**groups: float) -> NotebookNode:
    return notebook(
        *(code("", name, nbgrader=grade(name, points), course={"group": name}) for name, points in groups.items())
    )


def differences(notebook: NotebookNode) -> list[str]:
    return [str(finding) for finding, _ in point_differences("n.ipynb", notebook, POINTS)]


def correct(notebook: NotebookNode) -> None:
    for _, correction in list(point_differences("n.ipynb", notebook, POINTS)):
        assert correction is not None
        correction()


def test_each_cell_gets_the_points_of_its_group() -> None:
    notebook = graded(reaction=0, graph=0)
    correct(notebook)
    assert [cell.metadata.nbgrader.points for cell in notebook.cells] == [3.5, 1.0]
    assert differences(notebook) == []


def test_points_that_a_person_gives_are_not_counted_by_the_suite() -> None:
    notebook = graded(reaction=0, graph=1)
    notebook.cells.append(prose("Why?", "why", nbgrader=manual("why", 6)))
    correct(notebook)
    assert [cell.metadata.nbgrader.points for cell in notebook.cells] == [3.5, 1.0, 6]
    assert differences(notebook) == []


def test_wrong_points_are_named() -> None:
    assert differences(graded(reaction=3, graph=1)) == [
        "n.ipynb, cell 'reaction': has 3 points, but the checks of 'reaction' have 3.5"
    ]


@pytest.mark.parametrize(
    ("nb", "message"),
    [
        (graded(graph=1, reaction=3.5), "its grade cells are not in the order of the suite: reaction, graph"),
        (graded(reaction=3.5), "group 'graph' has no grade cell"),
        (graded(reaction=3.5, graph=1, magic=1), "names the unknown group 'magic'; the suite's groups are reaction"),
        (notebook(code("", "bare", nbgrader=grade("bare", 1))), "names the unknown group None"),
        (
            notebook(
                *(code("", f"c{i}", nbgrader=grade(f"c{i}", 3.5), course={"group": "reaction"}) for i in range(2)),
                code("", "graph", nbgrader=grade("graph", 1), course={"group": "graph"}),
            ),
            "is the second cell of group 'reaction'",
        ),
    ],
)
def test_a_notebook_that_does_not_match_its_suite_is_left_to_the_author(nb: NotebookNode, message: str) -> None:
    ((finding, correction),) = (pair for pair in point_differences("n.ipynb", nb, POINTS) if message in str(pair[0]))
    assert correction is None, finding
