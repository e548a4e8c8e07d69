"""The grader unpickles no data that a student could have written."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from autograder.course_paths import ROOT

READS_OBJECTS = {"pickle", "cPickle", "dill", "cloudpickle", "shelve", "marshal", "joblib"}


def imported(text: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield (node.module or "").partition(".")[0]


def test_no_module_of_the_grader_imports_pickle_or_a_similar_module() -> None:
    paths = [path for part in ("autograder", "sim") for path in (ROOT / part).rglob("*.py")]
    assert not [path for path in paths if READS_OBJECTS & set(imported(path.read_text(encoding="utf-8")))]
    assert len(paths) > 300
