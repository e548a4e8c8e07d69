"""The population of mutants is the same each time, and its outcomes are counted."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from autograder.author.verification import survivors
from autograder.author.verification.mutation_run import FAILED, MutantResult
from autograder.author.verification.population import Population, population
from autograder.author.verification.survivors import ChapterMutationResult, faults, mutant_counts, reasons, report
from autograder.exceptions import GraderError
from autograder.suite import suites
from autograder.suite.suites import Suite

ASSIGNMENT = "02_nodes"


@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_each_mutant_has_its_own_text_and_name(assignment: str) -> None:
    found = population(assignment)
    assert found == population(assignment)
    assert len({mutant.id for mutant in found.mutants}) == len(found.mutants) > 100
    assert all(mutant.diff() for mutant in found.mutants)


@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_each_reason_for_a_survivor_names_an_existing_mutant(assignment: str) -> None:
    found = reasons(assignment, population(assignment))
    assert all(reason.startswith(survivors.KINDS) for reason in found.values())


def test_the_name_of_a_mutant_does_not_change_with_other_code(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from autograder.author.verification.population import _named

    before = _named("a.py", "f", "sign", ((4, 5, "2"),), "x = 1\n")
    after = _named("a.py", "f", "sign", ((10, 11, "2"),), "y = 0\nx = 1\n")
    assert before.id == after.id


def chapter_result(*killers: str) -> ChapterMutationResult:
    """Return what became of a chapter's first mutants."""
    mutants = population(ASSIGNMENT).mutants[: len(killers)]
    results = tuple(MutantResult(mutant.id, killer, 1.0, "") for mutant, killer in zip(mutants, killers, strict=True))
    return ChapterMutationResult(ASSIGNMENT, Population(mutants, 2), {}, results)


def with_reason(
    found: ChapterMutationResult, monkeypatch: pytest.MonkeyPatch, text: str, folder: Path
) -> ChapterMutationResult:
    """Return the same with the reasons of a file with this text."""
    real = suites.hidden(ASSIGNMENT)
    twin = replace(real, files=tuple(folder / "hidden" / path.name for path in real.files))
    assert isinstance(twin, Suite)
    monkeypatch.setattr(suites, "hidden", lambda assignment: twin)
    (folder / "survivors.yaml").write_text(text)
    return replace(found, reasons=reasons(ASSIGNMENT, found.population))


def test_a_survivor_needs_a_reason(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found = chapter_result(*["starts"] * 39, "")
    survivor = found.results[-1].id
    found = with_reason(found, monkeypatch, "[]", tmp_path)
    assert found.unexplained == [survivor]
    assert faults([found]) == [f"{ASSIGNMENT}: {survivor} survives without a reason"]
    found = with_reason(found, monkeypatch, f"- {{equivalent: so it is, mutants: ['{survivor}']}}", tmp_path)
    assert found.survivors == {survivor: "equivalent: so it is"}
    assert faults([found]) == []
    assert "| 39/40" in report([found])
    assert "39/39" in report([found])
    assert (found.killed, found.killable) == (39, 39)
    assert "equivalent: so it is" in report([found])
    assert mutant_counts([found])[ASSIGNMENT]["all"] == [39, 40]


LOW = "02_nodes: 37 of 40 mutants lose a check, at least 95% have to"
LOW_OF_ALL = "all chapters: 38 of 40 mutants lose a check, at least 97% have to"


@pytest.mark.parametrize(
    ("kind", "killed", "killable", "graded", "said"),
    [
        ("equivalent", 38, 38, [ASSIGNMENT], []),
        ("outside", 38, 40, [ASSIGNMENT], [LOW_OF_ALL]),
        ("outside", 38, 40, [ASSIGNMENT, "03_interfaces"], []),
        ("outside", 37, 40, [ASSIGNMENT, "03_interfaces"], [LOW]),
    ],
)
def test_the_score_leaves_out_the_equivalent_and_counts_those_outside_of_the_contract(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    kind: str,
    killed: int,
    killable: int,
    graded: list[str],
    said: list[str],
) -> None:
    found = chapter_result(*["starts"] * killed, *[""] * (40 - killed))
    names = [result.id for result in found.results[killed:]]
    found = with_reason(found, monkeypatch, f"- {{{kind}: so it is, mutants: {names}}}", tmp_path)
    monkeypatch.setattr(suites, "graded_assignments", lambda: graded)
    assert found.unexplained == []
    assert (found.killed, found.killable) == (killed, killable)
    assert faults([found]) == said


def test_a_part_of_a_population_has_no_score(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found = chapter_result("starts", "")
    survivor = found.results[-1].id
    found = with_reason(found, monkeypatch, f"- {{outside: so it is, mutants: ['{survivor}']}}", tmp_path)
    assert faults([replace(found, results=found.results[-1:])]) == []


def test_a_pair_of_mutants_has_the_reason_of_its_two_parts(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pair = next(mutant.id for mutant in population(ASSIGNMENT).mutants if mutant.operator == "pair")
    one, other = pair.split(" + ")
    text = f"- {{outside: who cares, mutants: ['{one}']}}\n- {{equivalent: the same, mutants: ['{other}']}}"
    found = ChapterMutationResult(ASSIGNMENT, population(ASSIGNMENT), {})
    assert with_reason(found, monkeypatch, text, tmp_path).reasons[pair] == "outside: who cares"


def test_a_mutant_that_was_not_graded_makes_the_proof_fail(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found = chapter_result(*["starts"] * 39, FAILED)
    found = with_reason(
        found, monkeypatch, f"- {{outside: nobody says so, mutants: ['{found.results[-1].id}']}}", tmp_path
    )
    assert faults([found]) == [f"{ASSIGNMENT}: the grader failed on {found.results[-1].id}"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("- {equivalent: x, mutants: [no such mutant]}", "no such mutants any more: no such mutant"),
        ("- {mutants: []}", "equivalent or outside"),
        ("- {equivalent: x, outside: y, mutants: []}", "equivalent or outside"),
    ],
)
def test_a_reason_that_matches_no_mutant_is_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, text: str, said: str
) -> None:
    with pytest.raises(GraderError, match=said):
        with_reason(ChapterMutationResult(ASSIGNMENT, population(ASSIGNMENT), {}), monkeypatch, text, tmp_path)
