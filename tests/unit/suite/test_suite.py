"""Suites are read whole, in order, or refused by name."""

from __future__ import annotations

import importlib
import itertools
import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

from autograder.exceptions import GraderError, UsageError
from autograder.suite import suites
from autograder.suite.declaration import check_of

HEAD = "from autograder.suite import check\n"
KIND = suites.HIDDEN
_NUMBERS = itertools.count()
WriteSuites = Callable[..., str]


@pytest.fixture
def write_suites(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> WriteSuites:
    """Write a package of checks with one hidden suite, of 01_tiny, from modules given as text; return its name."""
    monkeypatch.syspath_prepend(str(tmp_path))

    def write(modules: str = '("first", "second")', **texts: str) -> str:
        name = f"suites_{next(_NUMBERS)}"
        folder = tmp_path / name / "ch01_tiny" / KIND
        folder.mkdir(parents=True)
        for package in (folder.parent, folder.parent.parent):
            (package / "__init__.py").write_text("")
        (folder / "__init__.py").write_text(f'PACKAGES = ("tiny",)\nMODULES = {modules}\n')
        for module, text in texts.items():
            (folder / f"{module}.py").write_text(HEAD + textwrap.dedent(text))
        return name

    return write


def _check(name: str, needs: str = "()", points: float = 1, group: str = "g", after: str = "()") -> str:
    return f"""
@check(points={points}, group="{group}", needs={needs}, after={after})
def test_{name}():
    '''It is {name}.'''
"""


def test_checks_have_the_order_of_modules_and_of_lines(write_suites: WriteSuites) -> None:
    name = write_suites(first=_check("b", points=2) + _check("a", group="h"), second=_check("c", '("b",)', 0.5))
    suite = suites.read(name, "01_tiny", KIND)
    assert [check.id for check in suite.checks] == ["b", "a", "c"]
    assert [path.name for path in suite.files] == ["first.py", "second.py"]
    assert (suite.packages, suite.max_score, suite.groups) == (("tiny",), 3.5, {"g": 2.5, "h": 1.0})
    assert suites.assignments_with(name, KIND) == ["01_tiny"]


def test_results_show_the_groups_in_their_own_order_and_files_are_run_in_that_of_the_modules(
    write_suites: WriteSuites,
) -> None:
    name = write_suites(
        '("first", "second")\nGROUPS = ("g", "h")', first=_check("a", group="h"), second=_check("b", '("a",)')
    )
    suite = suites.read(name, "01_tiny", KIND)
    assert [check.id for check in suite.checks] == ["b", "a"]
    assert [path.name for path in suite.files] == ["first.py", "second.py"]
    assert suite.with_dependencies("b") == ("b", "a")
    name = write_suites('("first",)\nGROUPS = ("g",)', first=_check("a", group="h"))
    with pytest.raises(GraderError, match=r"GROUPS of the hidden checks does not name \['h'\]"):
        suites.read(name, "01_tiny", KIND)


def test_a_check_is_graded_with_the_checks_in_needs_and_without_those_in_after(write_suites: WriteSuites) -> None:
    first = _check("a") + _check("b", '("a",)') + _check("c")
    suite = suites.read(write_suites(first=first, second=_check("d", '("b",)', after='("c",)')), "01_tiny", KIND)
    assert suite.with_dependencies("d") == ("a", "b", "d")


def test_an_unknown_assignment_is_a_usage_error_that_names_the_known_ones(write_suites: WriteSuites) -> None:
    with pytest.raises(UsageError, match="no hidden checks for '09_none'; there are for: 01_tiny"):
        suites.read(write_suites(modules="()"), "09_none", KIND)


@pytest.mark.parametrize(
    ("first", "second", "reason"),
    [
        (_check("a"), _check("a"), "two checks are called 'a'"),
        (_check("a", '("b",)'), _check("b"), r"'a' names \['b'\], which must come before it"),
        (_check("a", '("a",)'), _check("b"), r"'a' names \['a'\]"),
        (_check("a"), _check("b", '("none",)'), r"'b' names \['none'\]"),
        (_check("a", after='("b",)'), _check("b"), r"'a' names \['b'\], which must come before it"),
        (_check("a", points=0), _check("b"), "points must be above 0"),
    ],
)
def test_a_suite_that_breaks_the_contract_is_refused(
    write_suites: WriteSuites, first: str, second: str, reason: str
) -> None:
    with pytest.raises(GraderError, match=reason):
        suites.read(write_suites(first=first, second=second), "01_tiny", KIND)


def test_a_failed_import_inside_a_suite_is_not_reported_as_a_missing_suite(write_suites: WriteSuites) -> None:
    with pytest.raises(ModuleNotFoundError, match="no_such_module"):
        suites.read(write_suites(first="import no_such_module", second=""), "01_tiny", KIND)


def test_every_hidden_suite_has_visible_checks_and_keeps_the_contract() -> None:
    assert "02_nodes" in suites.graded_assignments()
    for name in suites.graded_assignments():
        loaded = suites.hidden(name)
        assert len(loaded.checks) >= 15 or name >= "10", name  # the textbook's chapters are 01 to 09
        assert all(check.hints for check in loaded.checks)
        assert suites.visible(name).packages == loaded.packages


@pytest.mark.parametrize("kind", [suites.VISIBLE, suites.HIDDEN])
def test_every_module_with_checks_is_named_in_modules(kind: str) -> None:
    """A module that MODULES leaves out would never be run, and no error would say so."""
    parent = suites.__package__
    for assignment in suites.assignments_with(parent, kind):
        package = importlib.import_module(f"{parent}.ch{assignment}.{kind}")
        names = [path.stem for path in Path(package.__path__[0]).glob("*.py") if path.stem != "__init__"]
        modules = [importlib.import_module(f"{package.__name__}.{name}") for name in names]
        with_checks = {
            name for name, module in zip(names, modules, strict=True) if any(map(check_of, vars(module).values()))
        }
        assert with_checks == set(package.MODULES), package.__name__
