"""The rules for the modules of a suite: the settings in `__init__.py` and the declarations of checks.

`autograder.suite.suites` stops at the first mistake, often with one of Python's own messages. This module parses the
files without running them, and reports all mistakes at once, each as a sentence with its file and line.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from autograder import course_paths
from autograder.author.course.findings import Finding
from autograder.author.course.fixture_rules import unknown_fixtures
from autograder.author.course.python_files import (
    Function,
    PythonFile,
    argument,
    declaration,
    decorator_name,
    decorators,
    literal,
    read_python,
)
from autograder.author.course.schema_sentences import meant
from autograder.suite.declaration import PREFIX

TEXTS = ("PACKAGES", "MODULES", "GROUPS", "FOLDERS", "READS", "OWN_TESTS")
KNOWN = (*TEXTS, "BUILD_MAY_FAIL")
NEEDED = ("PACKAGES", "MODULES")
ARGUMENTS = ("points", "group", "covers", "needs", "after", "doc")  # of `check`
HELPERS = ("__init__.py", "conftest.py")


@dataclass(frozen=True)
class ReadSuite:
    """A parsed suite, which may be invalid.

    Attributes:
        findings: its problems.
        places: file and line of each check, by its id.
        sources: the folders of the reference that it grades, as far as they are known.
        is_complete: whether `places` contains every check.
    """

    findings: tuple[Finding, ...]
    places: dict[str, tuple[str, int]]
    sources: tuple[str, ...]
    is_complete: bool = False


def shown(path: Path) -> str:
    """Return a file's path for findings: relative to the course's folder, if it is inside."""
    root = course_paths.course().root
    return str(path.relative_to(root) if path.is_relative_to(root) else path)


def read_suite(assignment: str, kind: str) -> ReadSuite:
    """Parse the "visible" or "hidden" suite of an assignment."""
    folder = course_paths.CHECKS / f"ch{assignment}" / kind
    top = folder / "__init__.py"
    if not top.is_file():
        missing = Finding(shown(top), None, f"there are no {kind} checks: the file has to name PACKAGES and MODULES")
        return ReadSuite((missing,), {}, ())
    described = read_python(top, shown(top))
    constants = {name: literal(value) for name, value in described.constants()}
    files = {
        path.stem: read_python(path, shown(path)) for path in sorted(folder.glob("*.py")) if path.name not in HELPERS
    }
    findings = [*described.findings, *(finding for file in files.values() for finding in file.findings)]
    if not described.findings:
        findings += _described(described, folder, files)
    listed = _texts(constants.get("MODULES"))
    ordered = [name for name in listed if name in files] or list(files)
    broken = [name for name in ordered if files[name].findings or _has_tables(files[name])]
    places: dict[str, tuple[str, int]] = {}
    for name in ordered:
        findings += _checks(files[name], places, any(map(_has_tables, files.values())))
    findings += unknown_fixtures(folder, [files[name] for name in ordered])
    sources = _texts(constants.get("PACKAGES")) + _texts(constants.get("FOLDERS"))
    return ReadSuite(tuple(findings), places, sources, len(ordered) == len(listed) and not broken)


def _described(file: PythonFile, folder: Path, modules: dict[str, PythonFile]) -> Iterator[Finding]:
    """Yield the problems in the `__init__.py` of a suite."""
    values = dict(file.constants())
    for name, value in values.items():
        content = literal(value)
        if name not in KNOWN:
            yield file.finding(value, f"`{name}` is nothing that a suite says: {meant(name, list(KNOWN))}")
        elif name in TEXTS and isinstance(content, str):
            yield file.finding(
                value, f"`{name}` is a text, and not a tuple: write {name} = ({content!r},), with a comma"
            )
        elif name in TEXTS and content and not _texts(content):
            yield file.finding(value, f"`{name}` must be a tuple of texts, such as {name} = ('one', 'two')")
        elif name == "BUILD_MAY_FAIL" and content not in (True, False):
            yield file.finding(value, "`BUILD_MAY_FAIL` must be True or False")
    yield from (file.finding(None, f"has no `{name}`") for name in NEEDED if name not in values)
    listed, packages, folders, read = (
        _texts(literal(values.get(name))) for name in ("MODULES", "PACKAGES", "FOLDERS", "READS")
    )
    for name in listed:
        if name not in modules:
            yield file.finding(values["MODULES"], f"`MODULES` names {name!r}, and there is no {name}.py beside it")
    for name in packages + folders:
        if not (course_paths.SOLUTIONS / name).is_dir():
            where = values["PACKAGES" if name in packages else "FOLDERS"]
            yield file.finding(
                where, f"names {name!r}, and the reference has no folder {course_paths.course().solutions}/{name}"
            )
    for name in read:
        if not (course_paths.course().root / name).exists():
            yield file.finding(values["READS"], f"`READS` names {name!r}, and the course has no such file or folder")
    if listed:
        for name, module in modules.items():
            if name not in listed and (first := next(_declared(module), None)):
                message = f"no check of this file counts: `MODULES` in {folder.name}/__init__.py does not name {name!r}"
                yield module.finding(first, message)


def _checks(file: PythonFile, places: dict[str, tuple[str, int]], has_tables: bool) -> Iterator[Finding]:
    """Yield the problems in a module's declarations of checks, and add the location of each check to `places`."""
    for node in file.tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
            yield from _dependencies(file, node.value, places, None, has_tables)
    for function in file.functions():
        call = declaration(function)
        if call is None:
            if function.name.startswith(PREFIX):
                places.setdefault(function.name.removeprefix(PREFIX), (file.shown, function.lineno))
                message = (
                    f"`{function.name}` is not a check, and its points count for nothing: put @check(points=...) above"
                )
                yield file.finding(function, message)
            continue
        if not function.name.startswith(PREFIX):
            yield file.finding(function, f"the check `{function.name}` must have a name that begins with {PREFIX!r}")
        id = function.name.removeprefix(PREFIX)
        if not (ast.get_docstring(function) or "").strip():
            yield file.finding(function, f"the check `{id}` has no docstring, the sentence that the student reads")
        for word in call.keywords:
            if word.arg not in ARGUMENTS:
                message = f"`{word.arg}` is not an argument of @check: {meant(str(word.arg), ARGUMENTS)}"
                yield file.finding(word.value, message)
        points = literal(argument(call, "points"))
        if argument(call, "points") is None:
            yield file.finding(call, f"the check `{id}` does not say its `points`")
        if isinstance(points, (int, float)) and points <= 0:
            yield file.finding(call, f"the check `{id}` is worth {points}: points are above 0")
        above = function.decorator_list[: function.decorator_list.index(call)]
        if any(decorator_name(each) == "hint" for each in above):
            yield file.finding(above[0], f"the hints of the check `{id}` must be below @check, not above")
        if id in places:
            other = "{}:{}".format(*places[id])
            yield file.finding(function, f"two checks are called `{id}`: the other one is in {other}")
        yield from _dependencies(file, call, places, id, has_tables)
        places.setdefault(id, (file.shown, function.lineno))


def _dependencies(
    file: PythonFile, call: ast.Call, places: dict[str, tuple[str, int]], id: str | None, has_tables: bool
) -> Iterator[Finding]:
    """Yield a finding for each check that a declaration names but that is not declared before it."""
    whose = "the group" if id is None else f"the check `{id}`"
    for name in ("needs", "after"):
        names = literal(argument(call, name))
        if isinstance(names, str):
            message = f"`{name}` of {whose} is a text, and not a tuple: write {name}=({names!r},), with a comma"
            yield file.finding(argument(call, name), message)
        elif id is not None:
            for other in _texts(names):
                if other not in places and not has_tables:
                    message = f"the check `{id}` names `{other}` in `{name}`, and no check of this name precedes it"
                    yield file.finding(argument(call, name), message)


def _declared(module: PythonFile) -> Iterator[Function]:
    """Yield the functions of a module that are checks, or that pytest would treat as checks."""
    for function in module.functions():
        if function.name.startswith(PREFIX) or declaration(function) or "check_each_row" in decorators(function):
            yield function


def _has_tables(file: PythonFile) -> bool:
    """Return whether a module declares checks with the rows of a table, whose names cannot be parsed."""
    return any("check_each_row" in decorators(function) for function in file.functions())


def _texts(value: object) -> tuple[str, ...]:
    """Return a tuple or list of texts as a tuple, or an empty tuple for any other value."""
    return tuple(value) if isinstance(value, (tuple, list)) and all(isinstance(each, str) for each in value) else ()
