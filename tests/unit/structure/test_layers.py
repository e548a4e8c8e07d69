"""The import contracts of `pyproject.toml` are kept, and each of them fails when a module breaks it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[3]
LINT = Path(sys.executable).with_name("lint-imports")
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]

# What breaks each contract: the module that imports, what it imports, and the sentence of the report.
BREACHES = {
    "layers": ("autograder/run/sandbox/spec.py", "autograder.grade.pipeline", "autograder.run is not allowed to"),
    "chapters": (
        "autograder/checks/ch02_nodes/support/robot.py",
        "autograder.author.verification.cases",
        "autograder.checks.ch02_nodes.support is not allowed to import autograder.author.verification",
    ),
    "chapters-by-path": (
        "autograder/probes/linters.py",
        "autograder.checks.ch02_nodes.support.robot",
        "autograder.probes.linters -> autograder.checks.ch02_nodes.support.robot",
    ),
    "hidden": (
        "autograder/checks/ch05_parameters/visible/declared.py",
        "autograder.checks.ch05_parameters.hidden.changes",
        "visible is not allowed to import autograder.checks.ch05_parameters.hidden",
    ),
    "conftests": (
        "autograder/checks/ch02_nodes/hidden/graph.py",
        "autograder.checks.ch02_nodes.conftest",
        "autograder.checks.ch02_nodes.hidden.graph -> autograder.checks.ch02_nodes.conftest",
    ),
    "sandboxed": (
        "autograder/run/lockstep/stepper.py",
        "autograder.run.lockstep.lockstep_host.host",
        "autograder.run.lockstep.stepper -> autograder.run.lockstep.lockstep_host.host",
    ),
    "sim": ("sim/world.py", "autograder.layout", "sim is not allowed to import autograder"),
    "circles": ("sim/engine/shapes.py", "sim.engine.motion", "No cycles are allowed in sim.engine"),
}

# The stand-ins are imported under names of their own, so they stand outside of the project's contracts.
# Imports for type checkers do not count: as in Jazzy, an action's `parse` takes a parser, which returns actions.
LAUNCH = """
[tool.importlinter]
root_package = "launch"
exclude_type_checking_imports = true
[[tool.importlinter.contracts]]
id = "circles"
name = "No circle among the modules of the stand-in"
type = "acyclic_siblings"
ancestors = ["launch"]
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the modules and of their contracts."""
    root = tmp_path_factory.mktemp("copy")
    shutil.copy(ROOT / "pyproject.toml", root)
    for package in ("autograder", "sim"):
        for file in (ROOT / package).rglob("*.py"):
            (root / file.relative_to(ROOT)).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, root / file.relative_to(ROOT))
    return root


@contextmanager
def appended(file: Path, line: str) -> Iterator[None]:
    """Add a line to a file for as long as the block runs."""
    before = file.read_text()
    file.write_text(f"{before}\n{line}\n")
    try:
        yield
    finally:
        file.write_text(before)


def lint(root: Path, *contracts: str) -> tuple[int, str]:
    """Check some contracts, or all, and return the exit status and the report, its line breaks taken out."""
    ended = subprocess.run(
        [LINT, "--no-cache", "--no-logo", *(word for contract in contracts for word in ("--contract", contract))],
        cwd=root,
        env={**os.environ, "COLUMNS": "300"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    return ended.returncode, " ".join(ended.stdout.split())


def test_every_import_contract_has_a_test_that_breaks_it() -> None:
    assert list(BREACHES) == [contract["id"] for contract in CONTRACTS]


def test_all_import_contracts_are_kept(copy: Path) -> None:
    status, report = lint(copy)
    assert (status, f"Contracts: {len(CONTRACTS)} kept, 0 broken." in report) == (0, True), report


@pytest.mark.parametrize("contract", BREACHES)
def test_a_contract_fails_when_it_is_broken(copy: Path, contract: str) -> None:
    module, imported, sentence = BREACHES[contract]
    with appended(copy / module, f"import {imported}"):
        status, report = lint(copy, contract)
    assert (status, "Contracts: 0 kept, 1 broken." in report) == (1, True), report
    assert sentence in report


def test_a_part_without_a_layer_is_reported(copy: Path) -> None:
    new = copy / "autograder" / "newcomer.py"
    new.write_text('"""A part that nobody gave a place."""\n')
    status, report = lint(copy, "layers")
    new.unlink()
    assert status == 1
    assert "newcomer" in report


def test_the_launch_stand_in_imports_in_one_direction(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "autograder" / "ros" / "standins" / "launch", tmp_path / "launch")
    (tmp_path / "pyproject.toml").write_text(LAUNCH)
    status, report = lint(tmp_path)
    assert (status, "Contracts: 1 kept, 0 broken." in report) == (0, True), report
    with appended(tmp_path / "launch" / "event.py", "import launch.actions"):
        status, report = lint(tmp_path)
    assert (status, "No cycles are allowed in launch" in report) == (1, True), report


def test_the_contract_of_the_sandbox_names_every_program_that_runs_there() -> None:
    (contract,) = (contract for contract in CONTRACTS if contract["id"] == "sandboxed")
    found = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for pattern in ("*_host", "*_host.py", "*preload.py")
        for path in (ROOT / "autograder").rglob(pattern)
        if path.is_dir() or not any(parent.name.endswith("_host") for parent in path.parents)
    }
    inside = {
        f"autograder.run.fork_server.{name}" for name in ("children", "confinement", "emulation")
    }  # a forked program's own
    assert found | inside == set(contract["protected_modules"])
