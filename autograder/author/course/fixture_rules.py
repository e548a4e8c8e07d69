"""The rule for the arguments of checks: each must be a fixture of the chapter, of the grader, or of pytest.

pytest itself reports an undefined fixture only when a submission is graded.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path

from autograder.author.course.findings import Finding
from autograder.author.course.python_files import Function, PythonFile, declaration, decorators, literal, read_python
from autograder.author.course.schema_sentences import suggestion

GRADER_FIXTURES = ("workspace", "builds", "seed", "draw", "artifacts")  # see `autograder.grade.plugin`
PYTEST_FIXTURES = ("request", "tmp_path", "tmp_path_factory", "monkeypatch", "capsys", "capfd", "caplog", "recwarn")


def unknown_fixtures(folder: Path, modules: Iterable[PythonFile]) -> Iterator[Finding]:
    """Yield a finding for each argument of a check or fixture that does not name a fixture.

    Args:
        folder: the folder of a suite, in the folder of its chapter's checks.
        modules: the modules of the suite.
    """
    conftests = [path for path in (folder.parent / "conftest.py", folder / "conftest.py") if path.is_file()]
    shared_fixtures = {name for path in conftests for name in _fixtures(read_python(path))}
    for module in modules:
        known_fixtures = [*shared_fixtures, *_fixtures(module), *GRADER_FIXTURES]
        for function in module.functions():
            takes_row = "check_each_row" in decorators(function)  # the row is its first argument
            if not (declaration(function) or takes_row):
                continue
            for argument in [*function.args.args, *function.args.kwonlyargs][1 if takes_row else 0 :]:
                if argument.arg not in (*known_fixtures, *PYTEST_FIXTURES, *_parameters(function)):
                    message = f"`{function.name}` uses the unknown fixture `{argument.arg}`: " + suggestion(
                        argument.arg, known_fixtures
                    )
                    yield module.finding(argument, message)


def _fixtures(file: PythonFile) -> list[str]:
    """Return the names of the fixtures that a file defines, and of its imports, which may be fixtures."""
    imports = (node for node in ast.walk(file.tree) if isinstance(node, ast.ImportFrom))
    imported_names = [alias.asname or alias.name for node in imports for alias in node.names]
    return [function.name for function in file.functions() if "fixture" in decorators(function)] + imported_names


def _parameters(function: Function) -> list[str]:
    """Return the arguments that `pytest.mark.parametrize` provides."""
    call = decorators(function).get("parametrize")
    names = literal(call.args[0]) if isinstance(call, ast.Call) and call.args else None
    return names.replace(",", " ").split() if isinstance(names, str) else list(names or [])
