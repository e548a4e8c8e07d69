"""The rules for a whole course: its `course.yaml`, syllabus and worlds, and folders that do not belong to a chapter."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from autograder import course_paths
from autograder.author.course.chapter_rules import SUITE_KINDS, ParsedChapter, with_line
from autograder.author.course.findings import Finding, display_path, outdated_file
from autograder.author.course.syllabus import Syllabus, find_coverage
from autograder.author.course.sync import Chapter
from autograder.author.course.tables import COURSE_PAGE, course_page
from autograder.author.course.yaml_files import read_yaml
from sim import WorldError, load_world


def course_file_findings() -> tuple[Finding, ...]:
    """Return the problems in the current `course.yaml`. Reading any other part of the course requires this file."""
    root = Path(os.environ.get(course_paths.COURSE_VARIABLE) or course_paths.ROOT)
    path = root / course_paths.COURSE_FILE
    return read_yaml(path, label=str(path)).findings if path.is_file() else ()


def course_findings(parsed_chapters: Mapping[str, ParsedChapter], *, whole: bool) -> list[Finding]:
    """Return the problems of the course outside its chapters.

    Args:
        parsed_chapters: the parsed chapters, by name.
        whole: whether these are all chapters of the course. If not, rules that need all chapters are skipped.
    """
    findings = list(_coverage_findings(parsed_chapters, whole))
    if not whole:
        return findings
    findings = [*_misnamed_folders(), *_worlds_findings(), *findings]
    is_valid = not (findings or any(chapter.findings for chapter in parsed_chapters.values()))
    return list(_outdated_page()) if is_valid else findings


def _outdated_page() -> Iterator[Finding]:
    """Yield a finding if the page about the chapters is out of date. A new course does not have it yet."""
    path = course_paths.CHAPTERS / COURSE_PAGE
    if path.is_file():
        yield from outdated_file(path, course_page()[0])


def _misnamed_folders() -> Iterator[Finding]:
    """Yield a finding for each folder that looks like a chapter but would be ignored because of its name."""
    assignments = course_paths.assignments()
    for folder in sorted(
        path for path in course_paths.CHAPTERS.glob("*") if path.is_dir() and path.name[:1] not in "._"
    ):
        if folder.name not in assignments and (notebook_names := sorted(path.name for path in folder.glob("*.ipynb"))):
            message = f"is not a chapter: it has no {folder.name}.ipynb, only {', '.join(notebook_names)}"
            yield Finding(display_path(folder), None, message)
    for folder in sorted(path for path in course_paths.CHECKS.glob("ch*") if path.is_dir()):
        name = folder.name.removeprefix("ch")
        if name not in assignments and any((folder / kind).is_dir() for kind in SUITE_KINDS):
            yield Finding(display_path(folder), None, f"contains checks of {name!r}, but this chapter does not exist")


def _worlds_findings() -> Iterator[Finding]:
    for path in sorted(course_paths.WORLDS.glob("*.yaml")) if course_paths.WORLDS.is_dir() else ():
        try:
            if "image:" not in path.read_text(encoding="utf-8"):  # otherwise it is a map for map_server
                load_world(path)
        except WorldError as error:
            yield Finding(display_path(path), None, f"{error.problem}. {error.remedy}", error.line)


def _coverage_findings(parsed_chapters: Mapping[str, ParsedChapter], whole: bool) -> Iterator[Finding]:
    """Yield the differences between the syllabus and the readable chapters."""
    path = course_paths.course().root / course_paths.course().syllabus
    if not path.is_file():
        yield Finding(display_path(path), None, "is missing: it names the objectives of the course")
        return
    file = read_yaml(path, schema="syllabus.yaml")
    yield from file.findings
    if file.findings:
        return
    readable_chapters = [
        (name, chapter.notebook, chapter.hidden)
        for name, chapter in parsed_chapters.items()
        if chapter.notebook is not None and chapter.hidden is not None
    ]
    coverage = find_coverage(Syllabus.read(path), readable_chapters)
    is_complete = whole and len(readable_chapters) == len(parsed_chapters)
    lines = {key_path[-1]: line for key_path, line in file.lines.items() if len(key_path) == 2}
    for finding in coverage.findings:
        if finding.file != course_paths.course().syllabus:
            chapter = Chapter(course_paths.CHAPTERS / finding.file.removesuffix(".ipynb"))
            text = chapter.notebook_path.read_text(encoding="utf-8")
            yield replace(with_line(finding, text), file=display_path(chapter.notebook_path))
        elif is_complete:
            yield replace(
                finding, line=next((number for key, number in lines.items() if repr(key) in finding.message), 1)
            )
