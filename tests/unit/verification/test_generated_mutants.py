"""The generated mutants are the same each time, and their results are counted."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from autograder.author.verification import survivors
from autograder.author.verification.generated_mutants import GeneratedMutants, generated_mutants
from autograder.author.verification.mutation_run import FAILED, MutantResult
from autograder.author.verification.survivors import ChapterMutationResult, faults, mutant_counts, reasons, report
from autograder.exceptions import AutograderError
from autograder.suite import suites
from autograder.suite.suites import Suite

ASSIGNMENT = "02_nodes"


@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_each_mutant_has_its_own_text_and_name(assignment: str) -> None:
    generated = generated_mutants(assignment)
    assert generated == generated_mutants(assignment)
    assert len({mutant.id for mutant in generated.mutants}) == len(generated.mutants) > 100
    assert all(mutant.diff() for mutant in generated.mutants)


@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_each_reason_for_a_survivor_names_an_existing_mutant(assignment: str) -> None:
    by_mutant = reasons(assignment, generated_mutants(assignment))
    assert all(reason.startswith(survivors.KINDS) for reason in by_mutant.values())


def test_the_name_of_a_mutant_does_not_change_with_other_code(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from autograder.author.verification.generated_mutants import _make_mutant

    before = _make_mutant("a.py", "f", "sign", ((4, 5, "2"),), "x = 1\n")
    after = _make_mutant("a.py", "f", "sign", ((10, 11, "2"),), "y = 0\nx = 1\n")
    assert before.id == after.id


def chapter_result(*killers: str) -> ChapterMutationResult:
    """Return results of a chapter's first mutants, with these killers."""
    mutants = generated_mutants(ASSIGNMENT).mutants[: len(killers)]
    results = tuple(MutantResult(mutant.id, killer, 1.0, "") for mutant, killer in zip(mutants, killers, strict=True))
    return ChapterMutationResult(ASSIGNMENT, GeneratedMutants(mutants, 2), {}, results)


def with_reason(
    result: ChapterMutationResult, monkeypatch: pytest.MonkeyPatch, text: str, folder: Path
) -> ChapterMutationResult:
    """Return the chapter's results with the reasons from a file with this text."""
    real = suites.hidden(ASSIGNMENT)
    copy = replace(real, files=tuple(folder / "hidden" / path.name for path in real.files))
    assert isinstance(copy, Suite)
    monkeypatch.setattr(suites, "hidden", lambda assignment: copy)
    (folder / "survivors.yaml").write_text(text)
    return replace(result, reasons=reasons(ASSIGNMENT, result.generated))


def test_a_survivor_needs_a_reason(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    chapter = chapter_result(*["starts"] * 39, "")
    survivor = chapter.results[-1].id
    chapter = with_reason(chapter, monkeypatch, "[]", tmp_path)
    assert chapter.unexplained == [survivor]
    (mutant,) = (generated for generated in chapter.generated.mutants if generated.id == survivor)
    (message,) = faults([chapter])
    assert message.splitlines() == [
        f"{ASSIGNMENT}: {survivor} survives without a reason",
        *(f"    {line}" for line in mutant.diff().splitlines()),
    ]
    assert f"\n    {mutant.file}:" in message
    chapter = with_reason(chapter, monkeypatch, f"- {{equivalent: as stated, mutants: ['{survivor}']}}", tmp_path)
    assert chapter.survivors == {survivor: "equivalent: as stated"}
    assert faults([chapter]) == []
    assert "| 39/40" in report([chapter])
    assert "39/39" in report([chapter])
    assert (chapter.killed, chapter.killable) == (39, 39)
    assert "equivalent: as stated" in report([chapter])
    assert mutant_counts([chapter])[ASSIGNMENT]["all"] == [39, 40]


LOW = "02_nodes: 37 of 40 mutants fail a check, but at least 95% must"
LOW_OF_ALL = "all chapters: 38 of 40 mutants fail a check, but at least 97% must"


@pytest.mark.parametrize(
    ("kind", "killed", "killable", "graded", "message"),
    [
        ("equivalent", 38, 38, [ASSIGNMENT], []),
        ("outside", 38, 40, [ASSIGNMENT], [LOW_OF_ALL]),
        ("outside", 38, 40, [ASSIGNMENT, "03_interfaces"], []),
        ("outside", 37, 40, [ASSIGNMENT, "03_interfaces"], [LOW]),
    ],
)
def test_the_score_ignores_equivalent_mutants_and_counts_those_without_a_requirement(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    kind: str,
    killed: int,
    killable: int,
    graded: list[str],
    message: list[str],
) -> None:
    chapter = chapter_result(*["starts"] * killed, *[""] * (40 - killed))
    names = [result.id for result in chapter.results[killed:]]
    chapter = with_reason(chapter, monkeypatch, f"- {{{kind}: as stated, mutants: {names}}}", tmp_path)
    monkeypatch.setattr(suites, "graded_assignments", lambda: graded)
    assert chapter.unexplained == []
    assert (chapter.killed, chapter.killable) == (killed, killable)
    assert faults([chapter]) == message


def test_part_of_the_mutants_has_no_score(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    chapter = chapter_result("starts", "")
    survivor = chapter.results[-1].id
    chapter = with_reason(chapter, monkeypatch, f"- {{outside: as stated, mutants: ['{survivor}']}}", tmp_path)
    assert faults([replace(chapter, results=chapter.results[-1:])]) == []


def test_a_pair_of_mutants_inherits_the_reason_of_its_parts(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pair = next(mutant.id for mutant in generated_mutants(ASSIGNMENT).mutants if mutant.operator == "pair")
    first, second = pair.split(" + ")
    text = f"- {{outside: unspecified, mutants: ['{first}']}}\n- {{equivalent: the same, mutants: ['{second}']}}"
    chapter = ChapterMutationResult(ASSIGNMENT, generated_mutants(ASSIGNMENT), {})
    assert with_reason(chapter, monkeypatch, text, tmp_path).reasons[pair] == "outside: unspecified"


def test_a_mutant_that_was_not_graded_fails_the_verification(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    chapter = chapter_result(*["starts"] * 39, FAILED)
    chapter = with_reason(
        chapter, monkeypatch, f"- {{outside: unspecified, mutants: ['{chapter.results[-1].id}']}}", tmp_path
    )
    last = replace(chapter.results[-1], error="OSError: the disk is full")
    chapter = replace(chapter, results=(*chapter.results[:-1], last))
    assert faults([chapter]) == [f"{ASSIGNMENT}: the grader failed on {last.id}: OSError: the disk is full"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("- {equivalent: x, mutants: [no such mutant]}", "these mutants no longer exist: no such mutant"),
        ("- {mutants: [a]}", "each entry has one reason, `equivalent` or `outside`"),
        ("- {equivalent: x, outside: y, mutants: [a]}", "each entry has one reason, `equivalent` or `outside`"),
        ("- {equivalent: x, mutants: [a]}\n- {outside: y, mutants: [a]}", "there are two reasons for a: keep one"),
    ],
)
def test_a_reason_that_matches_no_mutant_is_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, text: str, message: str
) -> None:
    with pytest.raises(AutograderError, match=message):
        with_reason(ChapterMutationResult(ASSIGNMENT, generated_mutants(ASSIGNMENT), {}), monkeypatch, text, tmp_path)
