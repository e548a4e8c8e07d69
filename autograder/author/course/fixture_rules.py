"""The rule for the arguments of checks: each must be a fixture of the chapter, of the grader, or of pytest.

pytest itself only reports an undefined fixture when a submission is graded.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path

from autograder.author.course.findings import Finding
from autograder.author.course.python_files import Function, PythonFile, declaration, decorators, literal, read_python
from autograder.author.course.schema_sentences import meant

OF_EVERY_CHAPTER = ("workspace", "builds", "seed", "draw", "artifacts")  # of `autograder.grade.plugin`
OF_PYTEST = ("request", "tmp_path", "tmp_path_factory", "monkeypatch", "capsys", "capfd", "caplog", "recwarn")


def unknown_fixtures(folder: Path, modules: Iterable[PythonFile]) -> Iterator[Finding]:
    """Yield a finding for each argument of a check or fixture that does not name a fixture.

    Args:
        folder: the folder of a suite, in the folder of its chapter's checks.
        modules: the modules of the suite.
    """
    conftests = [
        read_python(path, path.name)
        for path in (folder.parent / "conftest.py", folder / "conftest.py")
        if path.is_file()
    ]
    shared = {name for file in conftests for name in _fixtures(file)}
    for module in modules:
        known = [*shared, *_fixtures(module), *OF_EVERY_CHAPTER]
        for function in module.functions():
            is_body = "check_each_row" in decorators(function)
            if not (declaration(function) or is_body):
                continue
            arguments = [*function.args.args, *function.args.kwonlyargs][1 if is_body else 0 :]
            for each in arguments:
                if each.arg not in (*known, *OF_PYTEST, *_parameters(function)):
                    yield module.finding(
                        each, f"`{function.name}` asks for a fixture `{each.arg}`: {meant(each.arg, known)}"
                    )


def _fixtures(file: PythonFile) -> list[str]:
    """Return the names of the fixtures that a file defines, and of its imports, which may be fixtures."""
    imports = (node for node in ast.walk(file.tree) if isinstance(node, ast.ImportFrom))
    imported = [alias.asname or alias.name for node in imports for alias in node.names]
    return [function.name for function in file.functions() if "fixture" in decorators(function)] + imported


def _parameters(function: Function) -> list[str]:
    """Return the arguments that `pytest.mark.parametrize` provides."""
    calls = (each for each in decorators(function).items() if each[0] == "parametrize")
    arguments: list[str] = []
    for _, call in calls:
        names = literal(call.args[0]) if isinstance(call, ast.Call) and call.args else None
        arguments += names.replace(",", " ").split() if isinstance(names, str) else names or []
    return arguments
