"""The exercises of a notebook, and the checks that belong to each."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest
from nbformat import NotebookNode, write
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from autograder import course_paths
from autograder.exceptions import UsageError
from autograder.notebook.checking import Part, part_of
from autograder.notebook.exercises import Exercise, checks_of, exercises, find_exercise
from autograder.suite import suites


def _ids(assignment: str, name: str) -> tuple[str, ...]:
    parts = exercises(assignment)
    kind, number = name.split()
    return checks_of(find_exercise(assignment, parts, kind, int(number)), parts, suites.visible(assignment).checks)


@pytest.mark.parametrize("assignment", suites.checkable_assignments())
def test_each_visible_check_belongs_to_one_exercise_and_each_exercise_has_one(assignment: str) -> None:
    parts = [_ids(assignment, exercise.name) for exercise in exercises(assignment)]
    assert all(parts)
    assert sorted(itertools.chain(*parts)) == sorted(check.id for check in suites.visible(assignment).checks)


@pytest.mark.promise("Where the notebook has steps or questions, write `step=2` or `question=3`.")
@pytest.mark.parametrize(
    ("assignment", "name", "expected"),
    [
        ("01_package_structure", "exercise 2", ("alarm_builds", "alarm_runs", "alarm_dependencies", "alarm_facts")),
        ("03_interfaces", "exercise 1", ("robot_status", "check_trip", "drive_distance", "builds")),
        # The sentences of one check are in exercise 1, but students write the method that it tests in exercise 2.
        ("05_parameters", "exercise 2", ("contradiction", "together", "rate", "refused_whole", "lets_pass")),
        ("08_capstone", "step 2", ("starts", "sees", "moves", "enable", "watches")),
        ("08_capstone", "step 7", ("quality",)),
        ("09_assessment", "question 1", ("answered",)),
    ],
)
def test_the_checks_of_an_exercise_are_those_of_its_sentences(
    assignment: str, name: str, expected: tuple[str, ...]
) -> None:
    assert _ids(assignment, name) == expected


def test_an_unknown_exercise_number_is_answered_with_the_known_ones() -> None:
    with pytest.raises(UsageError) as excinfo:
        part_of("03_interfaces", exercise=4, step=None, question=None)
    assert str(excinfo.value) == (
        "03_interfaces has no exercise 4; it has: exercise 1 (a package of interfaces), "
        "exercise 2 (a node that publishes and serves), exercise 3 (drive a distance)"
    )
    with pytest.raises(UsageError, match=r"08_capstone has no exercise 1; it has: step 1 \(two packages\), step 2"):
        part_of("08_capstone", exercise=1, step=None, question=None)
    with pytest.raises(UsageError, match="exercise 1 and step 2 are two parts of 08_capstone: ask for one at a time"):
        part_of("08_capstone", exercise=1, step=2, question=None)
    assert part_of("08_capstone", None, None, None) == Part("08_capstone")


def _contract_cell(source: str, *sentences: str, **other_sentences: str) -> NotebookNode:
    return new_markdown_cell(
        source, metadata={"course": {"contract": dict.fromkeys(sentences, "a text")}}, **other_sentences
    )


@pytest.fixture
def chapter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The notebook of a chapter `x`."""
    path = tmp_path / "x.ipynb"
    monkeypatch.setattr(course_paths, "source_notebook", lambda assignment: path)
    return path


def test_an_exercise_ends_at_the_next_heading_of_its_level_and_headings_in_code_do_not_count(chapter: Path) -> None:
    cells = [
        _contract_cell("# Exercise of the mind\n\nBefore.", "before"),
        _contract_cell("## Exercise: the *only* `one`\n\n```\n## Exercise 7: a comment\n```", "first"),
        new_code_cell("## Exercise 8: a comment", metadata={"course": {"contract": {"second": "a text"}}}),
        _contract_cell("### More of it", "third"),
        _contract_cell("## Check it", "after"),
        _contract_cell("## Question 2: in your own words"),
    ]
    write(new_notebook(cells=cells), chapter)
    assert exercises("x") == (Exercise("exercise", 1, "the only one", ("first", "second", "third")),)


def test_files_that_only_later_cells_write_belong_to_later_parts(chapter: Path) -> None:
    cells = [
        new_code_cell("%%writefile ws/given.py\na = 0"),
        _contract_cell("## Exercise 1", "first"),
        new_code_cell("%%writefile ws/one.py\na = 1"),
        new_markdown_cell("## Between"),
        new_code_cell("%%writefile ws/between.py\na = 2"),
        new_code_cell("%%writefile ws/one.py\na = 3"),
        _contract_cell("## Exercise 2", "second"),
        new_code_cell("%%writefile ws/two.py\na = 4"),
    ]
    write(new_notebook(cells=cells), chapter)
    parts = exercises("x")
    assert [part.later for part in parts] == [("ws/between.py", "ws/two.py"), ()]
    assert Part("x", "exercise 1", parts).later == ("ws/between.py", "ws/two.py")
    assert Part("x", "", parts).later == ()


@pytest.mark.parametrize("text", ['{"cells": [{"cell_type": "mark', "[]", '{"cells": [1], "metadata": {}}'])
def test_a_notebook_that_cannot_be_read_is_named(text: str, chapter: Path) -> None:
    chapter.write_text(text)
    with pytest.raises(UsageError, match=r"x\.ipynb cannot be read as a notebook: save it in JupyterLab"):
        exercises("x")
