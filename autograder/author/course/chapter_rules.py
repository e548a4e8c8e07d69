"""Applies all rules to a chapter at once, so that a mistake in one file does not hide a mistake in another.

Nothing is graded. All readable files are examined, even if the suites cannot be imported.
"""

from __future__ import annotations

import json
import re
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from nbformat import NotebookNode

from autograder import course_paths
from autograder.author.course.cells import is_graded, metadata_findings
from autograder.author.course.contract_rules import cells_findings, coverage_findings
from autograder.author.course.copy_rules import target_findings
from autograder.author.course.exceptions import CourseError
from autograder.author.course.findings import Finding, display_path, outdated_file
from autograder.author.course.import_rules import imports_findings
from autograder.author.course.mutant_rules import mutants_findings, unknown_records, unproven_checks
from autograder.author.course.notebook_rules import rules_findings
from autograder.author.course.reference_rules import packages_findings, python_findings
from autograder.author.course.suite_rules import read_suite
from autograder.author.course.sync import Chapter, find_outdated
from autograder.author.course.tables import titles_of
from autograder.author.course.variant_rules import variants_findings
from autograder.author.course.workload import outdated_time_sentence
from autograder.exceptions import AutograderError
from autograder.suite import Check, Visibility, suites

SUITE_KINDS = (suites.VISIBLE, suites.HIDDEN)


@dataclass(frozen=True)
class ParsedChecks:
    """The checks of a chapter, as read from their files and the files beside them.

    Attributes:
        findings: the problems in these files.
        checks: the visible and the hidden checks, or None if they cannot be imported.
        points: the points of each group of hidden checks, or None if they cannot be imported.
        locations: the file and line of each check; the keys have the form `VISIBILITY ID`.
    """

    findings: tuple[Finding, ...]
    checks: tuple[Check, ...] | None
    points: dict[str, float] | None
    locations: dict[str, tuple[str, int]]


@dataclass(frozen=True)
class ParsedChapter:
    """A chapter as read from its files.

    Attributes:
        findings: all its problems.
        notebook: its notebook, or None if it cannot be read or has invalid metadata.
        hidden: its hidden checks, or None if they cannot be imported.
    """

    findings: tuple[Finding, ...]
    notebook: NotebookNode | None
    hidden: tuple[Check, ...] | None


def read_chapter(chapter: Chapter) -> ParsedChapter:
    """Read a chapter, its checks and its reference, and apply all rules to them."""
    notebook, findings = _read_notebook(chapter)
    folder = course_paths.CHECKS / f"ch{chapter.assignment}"
    has_checks = (folder / suites.HIDDEN).is_dir() or (notebook is not None and any(map(is_graded, notebook.cells)))
    parsed_checks = read_checks(chapter.assignment) if has_checks else ParsedChecks((), (), None, {})
    name = chapter.notebook_path.name
    if notebook is not None:
        text = chapter.notebook_path.read_text(encoding="utf-8")
        invalid_metadata = [*metadata_findings(name, notebook)]
        if invalid_metadata:
            findings = [*invalid_metadata, *rules_findings(name, notebook)]
        else:
            findings = _notebook_findings(chapter, notebook, parsed_checks)
        findings = [with_line(finding, text) if finding.file == name else finding for finding in findings]
        notebook = None if invalid_metadata else notebook
    path = display_path(chapter.notebook_path)
    findings = [replace(finding, file=path) if finding.file == name else finding for finding in findings]
    hidden = (
        None
        if parsed_checks.checks is None
        else tuple(c for c in parsed_checks.checks if c.visibility is Visibility.HIDDEN)
    )
    if hidden:
        mutant_findings = [*unproven_checks(folder, [check.id for check in hidden]), *unknown_records(folder)]
        findings = [*mutant_findings, *_outdated_titles(chapter.assignment), *findings]
    # Such an import works today, so it is no reason to refuse a verification.
    findings = [*imports_findings(folder), *findings]
    return ParsedChapter((*parsed_checks.findings, *findings), notebook, hidden)


def read_checks(assignment: str) -> ParsedChecks:
    """Read the checks of a chapter, the mutants and variants beside them, and the packages that they grade."""
    folder = course_paths.CHECKS / f"ch{assignment}"
    parsed_suites = {kind: read_suite(assignment, kind) for kind in SUITE_KINDS}
    findings = [finding for suite in parsed_suites.values() for finding in suite.findings]
    findings += python_findings(folder)
    locations = {
        f"{kind} {id}": location for kind, suite in parsed_suites.items() for id, location in suite.locations.items()
    }
    checks, points = None, None
    try:
        hidden, visible = suites.hidden(assignment), suites.visible(assignment)
        checks, points = (*visible.checks, *hidden.checks), hidden.groups
    except Exception as error:  # an author's module may raise anything
        findings += [] if findings else [_import_error(error, folder)]  # earlier findings are more precise
    hidden_suite = parsed_suites[suites.HIDDEN]
    sources = hidden_suite.sources
    if not all((course_paths.SOLUTIONS / source).is_dir() for source in sources):
        sources = ()  # one of the names is wrong, which was already reported
    ids = None if checks is None else [check.id for check in checks if check.visibility is Visibility.HIDDEN]
    if ids is None and hidden_suite.is_complete:
        ids = [*hidden_suite.locations]
    findings += packages_findings(sources)
    findings += mutants_findings(folder, ids, sources)
    findings += variants_findings(folder / "variants", sources)
    return ParsedChecks(tuple(findings), checks, points, locations)


def require_checks(assignments: Iterable[str]) -> None:
    """Raise a CourseError with all problems of the suites that cannot be imported."""
    graded_assignments = suites.graded_assignments()
    parsed_chapters = [read_checks(name) for name in assignments if name in graded_assignments]
    if problems := [
        str(finding)
        for chapter_checks in parsed_chapters
        if chapter_checks.checks is None
        for finding in chapter_checks.findings
    ]:
        raise CourseError("\n".join(dict.fromkeys(problems)))


def _outdated_titles(assignment: str) -> Iterator[Finding]:
    """Yield a finding if the titles of the hidden checks, which are shown to students, are out of date."""
    yield from outdated_file(course_paths.hidden_titles(assignment), titles_of(assignment))


def _import_error(error: Exception, folder: Path) -> Finding:
    """Return a finding for an exception that a suite raised, at the innermost line of the chapter's own code."""
    frames = [
        frame for frame in traceback.extract_tb(error.__traceback__) if Path(frame.filename).is_relative_to(folder)
    ]
    init_path = folder / (suites.VISIBLE if suites.VISIBLE in str(error) else suites.HIDDEN) / "__init__.py"
    file, line = (Path(frames[-1].filename), frames[-1].lineno) if frames else (init_path, 1)
    is_explained = isinstance(error, AutograderError)
    message = str(error) if is_explained else f"cannot be imported: {type(error).__name__}: {error}"
    return Finding(display_path(file), None, message, line)


def _read_notebook(chapter: Chapter) -> tuple[NotebookNode | None, list[Finding]]:
    """Return the notebook of a chapter, or None and the reason why it cannot be read."""
    try:
        return chapter.read(), []
    except CourseError as error:
        name, message, line = chapter.notebook_path.name, str(error), 1
        try:
            json.loads(chapter.notebook_path.read_text(encoding="utf-8"))
        except json.JSONDecodeError as json_error:
            message, line = f"is not JSON: {json_error.msg}", json_error.lineno
        return None, [Finding(name, None, message.removeprefix(f"{name} ").removeprefix(f"{name}: "), line)]


def _notebook_findings(chapter: Chapter, notebook: NotebookNode, parsed_checks: ParsedChecks) -> list[Finding]:
    """Return the problems in a notebook. Rules that need its checks are skipped if the checks are invalid."""
    if not notebook.cells:
        return rules_findings(chapter.notebook_path.name, notebook)
    name = chapter.notebook_path.name
    rules: Sequence[Callable[[], Iterable[Finding]]] = (
        lambda: find_outdated(chapter, notebook, parsed_checks.points),
        lambda: target_findings(name, notebook),
        lambda: rules_findings(name, notebook),
        lambda: outdated_time_sentence(name, notebook),
        lambda: cells_findings(name, notebook),
        lambda: (
            ()
            if not parsed_checks.checks
            else coverage_findings(name, notebook, parsed_checks.checks, parsed_checks.locations)
        ),
    )
    return [finding for rule in rules for finding in _apply_rule(name, rule)]


def _apply_rule(name: str, rule: Callable[[], Iterable[Finding]]) -> Iterator[Finding]:
    """Yield the findings of a rule. An error of nbgrader about a cell that it cannot release becomes a finding."""
    try:
        yield from rule()
    except (CourseError, RuntimeError) as error:
        yield Finding(name, None, str(error))


def with_line(finding: Finding, text: str) -> Finding:
    """Add a line to a finding in a notebook: that of a name in its message, else that of its cell, else the first."""
    if finding.line is not None:
        return finding
    lines = text.splitlines()
    start = _line_index(lines, f'"id": "{finding.cell}"', 0) if finding.cell else None
    cell_end = len(lines) if start is None else _line_index(lines, '"cell_type":', start) or len(lines)
    names = re.findall(r"(?:['`]|given file )([^'` ]+)", finding.message.partition("\n")[0])
    indices = (_line_index(lines, f'"{name}"', start or 0) for name in names)
    index = next((candidate for candidate in indices if candidate is not None and candidate < cell_end), start)
    return replace(finding, line=1 if index is None else index + 1)


def _line_index(lines: Sequence[str], text: str, start: int) -> int | None:
    return next((index for index in range(start, len(lines)) if text in lines[index]), None)
