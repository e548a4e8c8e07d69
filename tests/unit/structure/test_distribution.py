"""The facts of the ROS distribution are in one file; all else reads them there, or agrees with it."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from autograder.ros.distribution import DISTRIBUTION, PlatformPackage

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[3]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
# Chapters and their checks are texts for students, which a course for another distribution rewrites.
CODE = [path for folder in ("autograder", "sim", "docs", "assets") for path in sorted((ROOT / folder).rglob("*.py"))]
CODE = [path for path in CODE if ROOT / "autograder" / "checks" not in path.parents]
RECIPES = [ROOT / "Makefile", ROOT / "assets" / "students" / "Makefile", ROOT / ".ci" / "run"]
IMAGES = [".binder/Dockerfile", "docs/cluster/Dockerfile"]
IMAGES += [str(path.relative_to(ROOT)) for path in sorted((ROOT / ".github").rglob("*.yml"))]
FOLDERS = {".binder", ".ci", ".devcontainer", ".github"}
FOLDERS |= {"assets", "autograder", "chapters", "docs", "sim", "solutions", "tests"}
GUIDE = (ROOT / "docs" / "distribution.md").read_text(encoding="utf-8")
NOT_CHANGED = {"CHANGELOG.md", "docs/distribution.md"}  # they describe this distribution and earlier releases
CODENAME = DISTRIBUTION.platform_page.rpartition("/")[2]
FACT = re.compile(rf"{DISTRIBUTION.name}|{re.escape(DISTRIBUTION.platform)}|\b{CODENAME}\b|python3\.\d", re.IGNORECASE)
VERSIONS = {
    DISTRIBUTION.rclpy,
    *DISTRIBUTION.pythons,
    *DISTRIBUTION.tags.values(),
    *(each.version for each in DISTRIBUTION.packages),
}


def words(code: str) -> Iterator[str]:
    """Yield the names and texts of a module, without its docstrings and comments."""
    tree = ast.parse(code)
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    docstrings = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, documented) and node.body and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
            yield node.value
        for field in ("id", "attr", "name", "arg", "module"):
            if isinstance(name := getattr(node, field, None), str):
                yield name


def test_no_code_states_a_fact_of_the_distribution() -> None:
    assert len(CODE) > 300
    facts = {
        str(path.relative_to(ROOT)): mentions
        for path in CODE
        if (mentions := [word for word in words(path.read_text()) if FACT.search(word) or word in VERSIONS])
    }
    assert facts == {}, "read it from autograder.ros.distribution"


def test_no_recipe_states_a_fact_of_the_distribution() -> None:
    for path in RECIPES:
        lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
        assert [line for line in lines if FACT.search(line)] == [], path


def test_the_guide_to_a_port_names_each_file_that_mentions_the_distribution() -> None:
    rows = re.findall(r"^\| (`.+?) \|", GUIDE, re.MULTILINE)
    patterns = [name.rstrip("/") for row in rows for name in re.findall(r"`([^`]+)`", row)]
    assert [name for name in patterns if not list(ROOT.glob(name))] == []
    listed = {path for name in patterns for path in ROOT.glob(name)}
    unlisted = [path for path in _project_files() if not listed & {path, *path.parents}]
    assert 200 < len(unlisted) < len(list(_project_files())) - 200
    missing = {path.relative_to(ROOT).as_posix() for path in unlisted if _mentions_the_distribution(path)}
    assert missing - NOT_CHANGED == set(), "add these files to the table in docs/distribution.md"


def _project_files() -> Iterator[Path]:
    """Yield the files of the project, apart from those that tools create."""
    folders = [path for path in ROOT.iterdir() if path.is_dir() and path.name in FOLDERS]
    for path in (*ROOT.iterdir(), *(path for folder in folders for path in folder.rglob("*"))):
        if path.is_file() and "__pycache__" not in path.parts:
            yield path


def _mentions_the_distribution(path: Path) -> bool:
    return DISTRIBUTION.name in path.read_text(encoding="utf-8", errors="ignore").lower()


def test_the_project_asks_for_the_wheels_and_the_pythons_of_the_distribution() -> None:
    names = [Requirement(line).name for line in PROJECT["dependencies"]]
    assert {name[: len("ros-") + len(DISTRIBUTION.name)] for name in names if name.startswith("ros-")} == {
        f"ros-{DISTRIBUTION.name}"
    }
    minors = sorted(int(python.partition(".")[2]) for python in DISTRIBUTION.pythons)
    assert PROJECT["requires-python"] == f">=3.{minors[0]},<3.{minors[-1] + 1}"


@pytest.mark.parametrize("package", DISTRIBUTION.packages, ids=lambda package: package.name)
def test_the_project_asks_for_the_version_of_the_platform(package: PlatformPackage) -> None:
    requirements = [Requirement(line) for line in PROJECT["dependencies"]]
    pinned = [str(requirement.specifier) for requirement in requirements if requirement.name == package.name]
    assert not pinned or f"=={package.version}" in pinned  # some come with another package, and the lock pins them


@pytest.mark.parametrize(
    "path", [".binder/Dockerfile", "docs/cluster/Dockerfile", *map(str, (ROOT / ".github").rglob("*.yml"))]
)
def test_images_and_workflows_are_those_of_the_platform(path: str) -> None:
    text = (ROOT / path).read_text()
    assert set(re.findall(r"(?:python: ?\"?|python-version: ?\"|python)(3\.\d+)", text)) <= {*DISTRIBUTION.pythons}
    assert {f"Ubuntu {version}" for version in re.findall(r"ubuntu[:-](\d+\.\d+)", text)} <= {DISTRIBUTION.platform}
