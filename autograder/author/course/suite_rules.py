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
from autograder.author.course.findings import Finding, display_path
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
from autograder.author.course.schema_sentences import suggestion
from autograder.suite.declaration import PREFIX

TUPLE_SETTINGS = ("PACKAGES", "MODULES", "GROUPS", "FOLDERS", "READS", "OWN_TESTS")
SETTINGS = (*TUPLE_SETTINGS, "BUILD_MAY_FAIL")
REQUIRED_SETTINGS = ("PACKAGES", "MODULES")
ARGUMENTS = ("points", "group", "covers", "needs", "after", "doc")  # the arguments of `check`
HELPERS = ("__init__.py", "conftest.py")


@dataclass(frozen=True)
class ParsedSuite:
    """A parsed suite, which may be invalid.

    Attributes:
        findings: its problems.
        locations: file and line of each check, by id.
        sources: the folders of the reference that the suite grades, as far as they are known.
        is_complete: whether `locations` contains every check.
    """

    findings: tuple[Finding, ...]
    locations: dict[str, tuple[str, int]]
    sources: tuple[str, ...]
    is_complete: bool = False


def read_suite(assignment: str, kind: str) -> ParsedSuite:
    """Parse the "visible" or "hidden" suite of an assignment."""
    folder = course_paths.CHECKS / f"ch{assignment}" / kind
    init_path = folder / "__init__.py"
    if not init_path.is_file():
        message = f"the {kind} checks are missing: this file must define PACKAGES and MODULES"
        return ParsedSuite((Finding(display_path(init_path), None, message),), {}, ())
    init = read_python(init_path)
    constants = {name: literal(value) for name, value in init.constants()}
    files = {path.stem: read_python(path) for path in sorted(folder.glob("*.py")) if path.name not in HELPERS}
    findings = [*init.findings, *(finding for file in files.values() for finding in file.findings)]
    if not init.findings:
        findings += _settings_findings(init, folder, files)
    listed_modules = _strings(constants.get("MODULES"))
    in_order = [name for name in listed_modules if name in files] or list(files)
    incomplete_modules = [name for name in in_order if files[name].findings or _has_tables(files[name])]
    locations: dict[str, tuple[str, int]] = {}
    for name in in_order:
        findings += _checks_findings(files[name], locations, any(map(_has_tables, files.values())))
    findings += unknown_fixtures(folder, [files[name] for name in in_order])
    sources = _strings(constants.get("PACKAGES")) + _strings(constants.get("FOLDERS"))
    return ParsedSuite(
        tuple(findings), locations, sources, len(in_order) == len(listed_modules) and not incomplete_modules
    )


def _settings_findings(file: PythonFile, folder: Path, modules: dict[str, PythonFile]) -> Iterator[Finding]:
    """Yield the problems in the `__init__.py` of a suite."""
    values = dict(file.constants())
    for name, value in values.items():
        setting_value = literal(value)
        if name not in SETTINGS:
            yield file.finding(value, f"`{name}` is not a setting of a suite: {suggestion(name, SETTINGS)}")
        elif name in TUPLE_SETTINGS and isinstance(setting_value, str):
            message = f"`{name}` is a string, not a tuple: write {name} = ({setting_value!r},), with a comma"
            yield file.finding(value, message)
        elif name in TUPLE_SETTINGS and setting_value and not _strings(setting_value):
            yield file.finding(value, f"`{name}` must be a tuple of strings, such as {name} = ('one', 'two')")
        elif name == "BUILD_MAY_FAIL" and setting_value not in (True, False):
            yield file.finding(value, "`BUILD_MAY_FAIL` must be True or False")
    yield from (file.finding(None, f"has no `{name}`") for name in REQUIRED_SETTINGS if name not in values)
    listed_modules, packages, folders, read_paths = (
        _strings(literal(values.get(name))) for name in ("MODULES", "PACKAGES", "FOLDERS", "READS")
    )
    for name in listed_modules:
        if name not in modules:
            yield file.finding(values["MODULES"], f"`MODULES` names {name!r}, but {name}.py does not exist beside it")
    for name in packages + folders:
        if not (course_paths.SOLUTIONS / name).is_dir():
            setting = values["PACKAGES" if name in packages else "FOLDERS"]
            message = f"names {name!r}, but the reference has no folder {course_paths.course().solutions}/{name}"
            yield file.finding(setting, message)
    for name in read_paths:
        if not (course_paths.course().root / name).exists():
            yield file.finding(values["READS"], f"`READS` names {name!r}, but the course has no such file or folder")
    if listed_modules:
        for name, module in modules.items():
            if name not in listed_modules and (first_check := next(_declared_checks(module), None)):
                init = f"{folder.name}/__init__.py"
                message = f"the checks in this file do not count: `MODULES` in {init} does not name {name!r}"
                yield module.finding(first_check, message)


def _checks_findings(file: PythonFile, locations: dict[str, tuple[str, int]], has_tables: bool) -> Iterator[Finding]:
    """Yield the problems in a module's declarations of checks, and add the location of each check to `locations`."""
    for node in file.tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
            yield from _dependencies_findings(file, node.value, locations, None, has_tables)
    for function in file.functions():
        call = declaration(function)
        if call is None:
            if function.name.startswith(PREFIX):
                locations.setdefault(function.name.removeprefix(PREFIX), (file.label, function.lineno))
                message = f"`{function.name}` is not a check and gives no points: decorate it with @check(points=...)"
                yield file.finding(function, message)
            continue
        if not function.name.startswith(PREFIX):
            yield file.finding(function, f"the check `{function.name}` must have a name that begins with {PREFIX!r}")
        id = function.name.removeprefix(PREFIX)
        if not (ast.get_docstring(function) or "").strip():
            yield file.finding(function, f"the check `{id}` has no docstring, the sentence that the student reads")
        for keyword in call.keywords:
            if keyword.arg not in ARGUMENTS:
                message = f"`{keyword.arg}` is not an argument of @check: {suggestion(str(keyword.arg), ARGUMENTS)}"
                yield file.finding(keyword.value, message)
        points = literal(argument(call, "points"))
        if argument(call, "points") is None:
            yield file.finding(call, f"the check `{id}` has no `points`")
        if points is not None and (isinstance(points, bool) or not isinstance(points, (int, float))):
            message = f"`points` of the check `{id}` is {points!r}: write a number, such as points=1, without quotes"
            yield file.finding(argument(call, "points"), message)
        elif points is not None and points <= 0:
            yield file.finding(call, f"the check `{id}` is worth {points}: points must be above 0")
        decorators_above = function.decorator_list[: function.decorator_list.index(call)]
        if any(decorator_name(decorator) == "hint" for decorator in decorators_above):
            yield file.finding(decorators_above[0], f"the hints of the check `{id}` must be below @check, not above")
        if id in locations:
            location = "{}:{}".format(*locations[id])
            yield file.finding(function, f"two checks are called `{id}`: the other one is in {location}")
        yield from _dependencies_findings(file, call, locations, id, has_tables)
        locations.setdefault(id, (file.label, function.lineno))


def _dependencies_findings(
    file: PythonFile, call: ast.Call, locations: dict[str, tuple[str, int]], id: str | None, has_tables: bool
) -> Iterator[Finding]:
    """Yield a finding for each check that a declaration names but that is not declared before it."""
    owner = "the group" if id is None else f"the check `{id}`"
    for name in ("needs", "after"):
        names = literal(argument(call, name))
        if isinstance(names, str):
            message = f"`{name}` of {owner} is a string, not a tuple: write {name}=({names!r},), with a comma"
            yield file.finding(argument(call, name), message)
        elif id is not None:
            for dependency in _strings(names):
                if dependency not in locations and not has_tables:
                    message = (
                        f"the check `{id}` names `{dependency}` in `{name}`, but no check of this name precedes it"
                    )
                    yield file.finding(argument(call, name), message)


def _declared_checks(module: PythonFile) -> Iterator[Function]:
    """Yield the functions of a module that are checks, or that pytest would treat as checks."""
    for function in module.functions():
        if function.name.startswith(PREFIX) or declaration(function) or "check_each_row" in decorators(function):
            yield function


def _has_tables(file: PythonFile) -> bool:
    """Return whether a module declares a check for each row of a table. The ids of such checks cannot be parsed."""
    return any("check_each_row" in decorators(function) for function in file.functions())


def _strings(value: object) -> tuple[str, ...]:
    """Return a tuple or list of strings as a tuple, or an empty tuple for any other value."""
    return tuple(value) if isinstance(value, (tuple, list)) and all(isinstance(item, str) for item in value) else ()
