"""The picture of the parts is drawn from its source, and its source agrees with the code."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path
from typing import Any

import grimp
import pytest
import yaml

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[3]
FIGURES = ROOT / "assets" / "figures"
SOURCE: dict[str, Any] = yaml.safe_load((FIGURES / "parts.yaml").read_text())
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]


def module(part: str) -> str:
    """Return the import name of a part."""
    return part if part == "sim" else f"autograder.{part}"


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    return grimp.build_graph("autograder", "sim", cache_dir=None)


def test_the_picture_is_drawn_from_its_source() -> None:
    svg = runpy.run_path(str(FIGURES / "parts.py"))["svg"](SOURCE)
    assert (FIGURES / "parts.svg").read_text() == svg, "run `python assets/figures/parts.py`"


def test_the_picture_contains_exactly_the_parts() -> None:
    packages = {path.parent.name for path in (ROOT / "autograder").glob("*/__init__.py")}
    modules = {path.stem for path in (ROOT / "autograder").glob("*.py") if not path.stem.startswith("__")}
    assert (set(SOURCE["packages"]), set(SOURCE["modules"])) == (packages | {"sim"}, modules), "see parts.yaml"


@pytest.mark.parametrize("arrow", SOURCE["arrows"])
def test_each_arrow_is_an_import(graph: grimp.ImportGraph, arrow: str) -> None:
    importer, imported = map(module, arrow.split(" -> "))
    assert graph.direct_import_exists(importer=importer, imported=imported, as_packages=True)


def test_modules_that_the_picture_puts_in_the_sandbox_may_not_be_imported_by_trusted_code() -> None:
    (contract,) = (contract for contract in CONTRACTS if contract["id"] == "sandboxed")
    sandboxed = {
        f"{module(name)}.{host}" for name, part in SOURCE["packages"].items() for host in part.get("sandbox", ())
    }
    assert sandboxed
    assert sandboxed <= set(contract["protected_modules"])


def test_each_step_of_a_submission_is_drawn_at_a_part() -> None:
    placed = {step for part in SOURCE["packages"].values() for step in part.get("steps", ())}
    placed |= {number for number, step in enumerate(SOURCE["way"], start=1) if step.get("module") in SOURCE["modules"]}
    assert placed == set(range(1, len(SOURCE["way"]) + 1))


def test_the_contract_of_the_sandbox_names_every_program_that_runs_there() -> None:
    (contract,) = (contract for contract in CONTRACTS if contract["id"] == "sandboxed")
    programs = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for pattern in ("*_host", "*_runner.py")
        for path in (ROOT / "autograder").rglob(pattern)
        if path.is_dir() or not any(parent.name.endswith(("_host", "standins")) for parent in path.parents)
    }
    forked_parts = {
        f"autograder.run.fork_server.{name}" for name in ("children", "confinement", "emulation")
    }  # a forked program's own
    assert programs | forked_parts == set(contract["protected_modules"])
