"""The rule for imports: of the autograder, a chapter's checks import only `autograder.checking` and other checks."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from autograder.author.course.findings import Finding
from autograder.author.course.python_files import read_python

PACKAGE, PUBLIC_PARTS = "autograder", ("checking", "checks")


def imports_findings(folder: Path) -> Iterator[Finding]:
    """Yield a finding for each import of another part of the autograder in a chapter's folder of checks."""
    for path in sorted(folder.rglob("*.py")):
        if "variants" in path.relative_to(folder).parts:  # students' files
            continue
        file = read_python(path)
        for node in ast.walk(file.tree):
            for module in _imported_modules(node):
                parts = module.split(".")
                if parts[0] == PACKAGE and parts[1:2] and parts[1] not in PUBLIC_PARTS:
                    message = f"imports `{module}`, which may change without notice: import from `autograder.checking`"
                    yield file.finding(node, message)


def _imported_modules(node: ast.AST) -> Iterator[str]:
    """Yield the full names of what a statement imports, at least as far as the part of the autograder."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
        yield from (f"{node.module}.{alias.name}" for alias in node.names) if node.module == PACKAGE else (node.module,)
