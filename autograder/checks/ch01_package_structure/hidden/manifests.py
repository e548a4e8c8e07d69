"""Checks of package.xml, which colcon and rosdep read, in the package that the student creates."""

from __future__ import annotations

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import imports, manifest
from autograder.checks.ch01_package_structure.support import contract
from autograder.checks.ch01_package_structure.support.assertions import (
    expect_declared,
    expect_licence,
    expect_manifest,
    expect_rosdep_key,
    read_manifest,
    source_of,
)

check = group("manifest")
DECLARE_HINTS = (
    "Name the package of each import in package.xml, except for modules of Python's standard library.",
    "rosdep reads only package.xml: it never installs what only setup.py names.",
)


@check(points=2, covers=("manifest", "build-type"), doc=contract.REP_149)
@hint("Compare it with the one that ros2 pkg create wrote: which tag is missing, or appears twice?")
@hint('<export><build_type>ament_python</build_type></export>, inside <package format="3">.')
def test_manifest(workspace: Workspace) -> None:
    """square_dance/package.xml describes a Python package, in format 3."""
    expect_manifest(workspace, contract.SQUARE_DANCE)


@check(points=1, covers="licence", after=("manifest",), doc=contract.REP_149)
@hint("A licence is named by its SPDX identifier.", "<license>Apache-2.0</license>")
def test_licence(workspace: Workspace) -> None:
    """package.xml names the licence Apache-2.0."""
    expect_licence(workspace, contract.SQUARE_DANCE)


@check(points=1, covers="description", after=("manifest",), doc=contract.CREATE)
@hint("ros2 pkg create leaves a TODO in the description.", "Say in half a sentence what the package is for.")
def test_description(workspace: Workspace) -> None:
    """package.xml describes the package."""
    description = read_manifest(workspace, contract.SQUARE_DANCE).description
    expect(
        len(description.split()) >= 3 and manifest.PLACEHOLDER not in description,
        f"The description is {description!r}; it should have three words or more, and no {manifest.PLACEHOLDER}.",
    )


@check(points=2, covers="dependencies", after=("manifest",), doc=contract.ROSDEP)
@hint(*DECLARE_HINTS)
def test_run_dependencies(workspace: Workspace) -> None:
    """package.xml declares what the package's modules import when they run."""
    needed_imports = imports.imported(source_of(workspace, contract.SQUARE_DANCE), without=("test", "launch"))
    expect_declared(needed_imports, read_manifest(workspace, contract.SQUARE_DANCE).needs("exec"))


@check(points=1, covers="dependencies", after=("manifest",), doc=contract.ROSDEP)
@hint(*DECLARE_HINTS)
def test_launch_dependencies(workspace: Workspace) -> None:
    """package.xml declares what the launch file imports, by <exec_depend> or <depend>."""
    needed_imports = imports.imported(source_of(workspace, contract.SQUARE_DANCE), within=("launch",))
    expect_declared(needed_imports, read_manifest(workspace, contract.SQUARE_DANCE).needs("exec"))


@check(points=1, covers="dependencies", after=("manifest",), doc=contract.ROSDEP)
@hint(*DECLARE_HINTS)
def test_test_dependencies(workspace: Workspace) -> None:
    """package.xml declares what test/ imports, by <test_depend>."""
    source = source_of(workspace, contract.SQUARE_DANCE)
    runtime_modules = {item.module for item in imports.imported(source, without=("test",))}
    needed_imports = [item for item in imports.imported(source, within=("test",)) if item.module not in runtime_modules]
    package_manifest = read_manifest(workspace, contract.SQUARE_DANCE)
    expect_declared(needed_imports, package_manifest.needs("exec", "test"))
    expect_rosdep_key(package_manifest.needs(), "pytest")
