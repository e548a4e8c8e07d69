"""Creates versions of a package under test, which differ only in their behaviour.

A test could report the expected result without running a version, if it recognised the version by the text of a file,
its hash or byte code, or by names, paths or times. So `obfuscate` rewrites every version, including the reference: it
removes comments and draws new docstrings, local names and private attributes in each run. Each docstring is then a leak
marker, and so is the last comment of a file: nothing that a student gets may contain one (`verification.leaks`).
Correct and faulty versions in different styles are mixed in an order drawn from the seed. All have the same files, with
the same times.

A test may still read the code of a version as a linter does, and find the fault there: that is allowed. A test that
fails at random does not help, because it has to pass on every correct version, and more than once.
"""

from __future__ import annotations

import ast
import os
import random
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeGuard

from autograder.probes.leak_markers import SYLLABLES, draw_marker
from autograder.ros.environment import site_packages

FILE_TIME = 1_750_000_000  # s since 1970, for every file of every version
_SCRIPT = """#!{python}
import sys

from {module} import main

sys.exit(main())
"""


@dataclass(frozen=True)
class Version:
    """A version of a package.

    Attributes:
        files: the texts of its files, by path below the package's folder. Those of its Python package, `launch` and
            `config` are installed.
        scripts: the modules with a `main`, as `package.module`, by the names of their executables.
    """

    files: Mapping[str, str]
    scripts: Mapping[str, str]


def read_files(folder: Path) -> dict[str, bytes]:
    """Read a package's files, by their paths below its folder."""
    paths = [path for path in sorted(folder.rglob("*")) if path.is_file() and "__pycache__" not in path.parts]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def read(folder: Path, scripts: Mapping[str, str]) -> Version:
    """Read a package's files except its tests."""
    files = read_files(folder)
    return Version({name: data.decode() for name, data in files.items() if not name.startswith("test/")}, scripts)


def obfuscate(version: Version, seed: int) -> Version:
    """Return a version with the same behaviour, and with Python files that differ for each seed."""
    draw = random.Random(seed)
    files = {name: _rewrite(text, draw) if name.endswith(".py") else text for name, text in version.files.items()}
    return with_markers(Version(files, version.scripts), draw)


def with_markers(version: Version, draw: random.Random) -> Version:
    """Return the version with a leak marker as the last comment of each Python and YAML file."""
    files = {
        name: f"{text.rstrip()}\n# {draw_marker(draw)}\n".lstrip() if name.endswith((".py", ".yaml")) else text
        for name, text in version.files.items()
    }
    return Version(files, version.scripts)


def write_version(version: Version, package: str, tests: Mapping[str, bytes], root: Path) -> Path:
    """Write a version as a colcon workspace below `root`, as if it had been built; return its source folder.

    Args:
        version: the package under test.
        package: the name of the package.
        tests: the files for the package's folder `test`.
        root: the workspace, to which `src/PACKAGE` and `install/PACKAGE` are written.
    """
    source, prefix = root / "src" / package, root / "install" / package
    for name, text in version.files.items():
        for path in (source / name, _install_path(prefix, package, name)):
            if path is not None:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
    index = prefix / "share/ament_index/resource_index/packages" / package
    index.parent.mkdir(parents=True, exist_ok=True)
    index.write_text("")
    for name, module in version.scripts.items():
        script = prefix / "lib" / package / name
        script.parent.mkdir(parents=True, exist_ok=True)
        script.write_text(_SCRIPT.format(python=sys.executable, module=module))
        script.chmod(0o755)
    for name, data in tests.items():
        path = source / "test" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    for path in sorted(root.rglob("*"), reverse=True):
        os.utime(path, (FILE_TIME, FILE_TIME))
    return source


def _install_path(prefix: Path, package: str, name: str) -> Path | None:
    top = Path(name).parts[0]
    if top == package:
        return site_packages(prefix) / name
    return prefix / "share" / package / name if top in ("launch", "config", "package.xml") else None


def _rewrite(text: str, draw: random.Random) -> str:
    tree, words = ast.parse(text), _words(draw)
    nodes = list(ast.walk(tree))  # walked once, because it is slow and done for hundreds of trees
    for node in nodes:
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            statements = node.body[ast.get_docstring(node) is not None :]
            node.body = [ast.Expr(ast.Constant(draw_marker(draw))), *statements]
    for function in (node for node in nodes if isinstance(node, ast.FunctionDef)):
        inner = list(ast.walk(function))
        names = {name: next(words) for name in sorted(_local_names(inner))}
        for node in inner:
            if isinstance(node, ast.Name) and node.id in names:
                node.id = names[node.id]
    for owner in (node for node in nodes if isinstance(node, ast.ClassDef)):
        attributes = [node for node in ast.walk(owner) if _is_attribute_of_self(node)]
        names = {name: next(words) for name in sorted({a.attr for a in attributes if isinstance(a.ctx, ast.Store)})}
        for attribute in attributes:
            attribute.attr = names.get(attribute.attr, attribute.attr)
    return ast.unparse(tree) + "\n"


def _local_names(nodes: Sequence[ast.AST]) -> set[str]:
    """Return the names to which a function with these nodes assigns, and which are local to it.

    Parameters are left out, because callers may pass them by name, and so are global and nonlocal names.
    """
    assigned_names = {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    excluded_names = {node.arg for node in nodes if isinstance(node, ast.arg)}
    excluded_names |= {name for node in nodes if isinstance(node, ast.Global | ast.Nonlocal) for name in node.names}
    return assigned_names - excluded_names


def _is_attribute_of_self(node: ast.AST) -> TypeGuard[ast.Attribute]:
    return isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self"


def _words(draw: random.Random) -> Iterator[str]:
    """Yield private names endlessly. No name is yielded twice, because two attributes must not get the same name."""
    yielded_words: set[str] = set()
    while True:
        word = "_" + "".join(draw.choice(SYLLABLES) for _ in range(4))
        if word not in yielded_words:
            yielded_words.add(word)
            yield word
