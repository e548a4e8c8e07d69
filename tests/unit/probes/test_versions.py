"""Versions of a package look different each time, behave the same, and cannot be told apart by paths or times."""

from __future__ import annotations

import ast
import random
from pathlib import Path
from typing import Any

import pytest

from autograder.checks.ch06_testing.hidden.faults import (
    STYLES,
    Fault,
    faults,
    faulty_version,
    minimal_version,
    reworded_version,
    version_in,
)
from autograder.exceptions import GraderError
from autograder.probes.leak_markers import markers_in
from autograder.probes.versions import FILE_TIME, Version, obfuscate, read, write_version

SOURCE = '''"""A secret comment."""

SCALE = 2  # doubles


class Counter:
    """Counts."""

    def __init__(self, start=0):
        """Start."""
        self.count = start

    def add(self, step=1):
        """Add."""
        bigger = self.count + step
        self.count = bigger
        return [number * SCALE for number in (bigger,)][0]


def outer(value, *, times=1):
    """Nest."""
    total = 0

    def inner(total):
        return total + value

    for _ in range(times):
        total = inner(total)
    return total
'''


def run(text: str) -> tuple[Any, ...]:
    space: dict[str, Any] = {}
    exec(compile(text, "module", "exec"), space)
    counter = space["Counter"](start=3)
    return counter.add(step=2), counter.add(), space["outer"](5, times=3)


def test_an_obfuscated_version_behaves_the_same_and_looks_different_for_each_seed() -> None:
    version = Version({"a/b.py": SOURCE, "config/a.yaml": "x: 1"}, {})
    texts = {obfuscate(version, seed).files["a/b.py"] for seed in range(5)}
    assert len(texts) == 5
    for text in texts:
        assert run(text) == run(SOURCE) == (10, 12, 15)
        for private in ("secret", "doubles", "Counts", "bigger", "self.count"):
            assert private not in text
        assert "SCALE = 2" in text
    assert obfuscate(version, 1) == obfuscate(version, 1)
    assert obfuscate(version, 1).files["config/a.yaml"].startswith("x: 1\n# ")


def test_no_two_names_of_an_obfuscated_version_become_one() -> None:
    numbers = range(3000)  # among so many, some names are drawn twice
    assignments = "\n".join(f"        self.attribute_{number} = local_{number} = {number}" for number in numbers)
    version = Version({"p/p.py": f"class Crowded:\n    def __init__(self):\n{assignments}\n"}, {})
    tree = ast.parse(obfuscate(version, 1).files["p/p.py"])
    attributes = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    locals_ = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    assert (len(attributes), len(locals_)) == (len(numbers), len(numbers))
    assert not attributes & locals_


def test_each_function_class_and_file_of_a_version_contains_a_leak_marker() -> None:
    files = obfuscate(Version({"a/b.py": SOURCE, "config/a.yaml": "x: 1", "a/__init__.py": ""}, {}), 1).files
    kinds = ast.Module | ast.ClassDef | ast.FunctionDef
    documented = [node for node in ast.walk(ast.parse(files["a/b.py"])) if isinstance(node, kinds)]
    markers = [ast.get_docstring(node) or "" for node in documented]
    assert len(markers) == 6
    markers += [text.rstrip().rpartition("# ")[2] for text in files.values()]
    assert len(set(markers)) == 9
    assert all(markers_in(marker) == {marker} for marker in markers)


def test_a_version_is_installed_as_a_build_would_install_it(tmp_path: Path) -> None:
    version = Version(
        {"p/a.py": "A = 1\n", "launch/a.launch.py": "B = 2\n", "setup.py": "", "package.xml": "<package/>"},
        {"tool": "p.a"},
    )
    source = write_version(version, "p", {"test_it.py": b""}, tmp_path / "ws")
    install = tmp_path / "ws/install/p"
    assert source == tmp_path / "ws/src/p"
    assert {path.relative_to(source).as_posix() for path in source.rglob("*.*")} == {
        "p/a.py",
        "launch/a.launch.py",
        "setup.py",
        "package.xml",
        "test/test_it.py",
    }
    assert (install / "share/p/launch/a.launch.py").read_text() == "B = 2\n"
    assert (install / "share/ament_index/resource_index/packages/p").is_file()
    assert (install / "lib/p/tool").stat().st_mode & 0o111
    assert len(list(install.glob("lib/python3*/site-packages/p/a.py"))) == 1
    assert {path.stat().st_mtime for path in (tmp_path / "ws").rglob("*")} == {FILE_TIME}


def test_a_packages_tests_and_caches_are_not_part_of_its_version(tmp_path: Path) -> None:
    for name in ("p/a.py", "p/__pycache__/a.pyc", "test/test_a.py", "package.xml"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    assert set(read(tmp_path, {}).files) == {"p/a.py", "package.xml"}


def test_all_versions_have_the_same_files() -> None:
    draw = random.Random(1)
    names = {frozenset(faulty_version(fault, name, draw).files) for fault in faults() for name in STYLES}
    assert names == {frozenset(version_in(name).files) for name in STYLES}
    assert len(names) == 1


@pytest.mark.parametrize("fault", faults(), ids=lambda fault: str(fault.id))
@pytest.mark.parametrize("name", STYLES)
def test_every_fault_applies_to_both_styles(fault: Fault, name: str) -> None:
    faulty = faulty_version(fault, name, random.Random(1)).files
    correct = obfuscate(version_in(name), random.Random(1).getrandbits(32)).files
    assert {path for path in correct if correct[path] != faulty[path]} >= {fault.file}
    compile(faulty[fault.file], fault.file, "exec")


def test_every_reworded_version_compiles_and_has_the_same_files() -> None:
    reworded_files = [reworded_version(random.Random(seed)).files for seed in range(30)]
    reworded_files.append(minimal_version(random.Random(1)).files)
    plain = obfuscate(version_in(STYLES[0]), 1).files
    assert all(files.keys() == plain.keys() for files in reworded_files)
    for name in (name for name in plain if name.endswith(".py")):
        for files in reworded_files:
            compile(files[name], name, "exec")


def test_a_fault_whose_text_is_not_found_is_named() -> None:
    fault = Fault("lost", "stop", "speed_guard/limits.py", dict.fromkeys(STYLES, ("no such text", "")), frozenset())
    with pytest.raises(GraderError, match=r"fault lost: 'no such text' occurs 0 times in speed_guard/limits.py"):
        faulty_version(fault, STYLES[0], random.Random(1))


def test_the_text_of_a_fault_must_occur_once_unless_the_fault_allows_more() -> None:
    edits = dict.fromkeys(STYLES, ("return", "return None or"))
    with pytest.raises(GraderError, match=r"occurs \d times"):
        faulty_version(Fault("twice", "stop", "speed_guard/limits.py", edits, frozenset()), STYLES[0], random.Random(1))
    repeated = Fault("twice", "stop", "speed_guard/limits.py", edits, frozenset(STYLES))
    text = faulty_version(repeated, STYLES[1], random.Random(1)).files["speed_guard/limits.py"]
    assert text.partition("\n# ")[0].endswith("return None or wanted")
