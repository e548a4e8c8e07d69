"""Question 3: the messages, and what the two packages declare and install."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checks import expect, group, hint
from autograder.checks.ch09_assessment.support import contract
from autograder.checks.ch09_assessment.support.contract import INTERFACES, PACKAGE, PROGRAMS
from autograder.checks.ch09_assessment.support.definitions import expect_definitions
from autograder.checks.ch09_assessment.support.robot import expect_executables, require_built, source_of
from autograder.diagnosis import Diagnosis
from autograder.harness import Workspace
from autograder.probes import imports, manifest
from autograder.probes.installed import look

check = group("packages")


@check(points=2, holds=("temperature", "decision"), doc=contract.INTERFACES_DOC)
@hint("Compare with the table of the messages, letter by letter.", "The order of the fields counts, too.")
def test_definitions(workspace: Workspace) -> None:
    """Both messages have the fields of the contract."""
    expect_definitions(workspace)


@check(points=2, holds="packages", depends=("definitions",), doc=contract.INTERFACES_DOC)
@hint('rosidl_generate_interfaces(${PROJECT_NAME} "msg/Decision.msg" "msg/Temperature.msg" DEPENDENCIES ...)')
@hint("find_package for what you use; in package.xml a buildtool_depend on the generators, and member_of_group.")
def test_messages_are_generated(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds motor_guard_interfaces, with both messages."""
    require_built(builds, INTERFACES)
    shared = look(workspace.install, INTERFACES).shared
    absent = [path for path in contract.MESSAGES if path not in shared]
    expect(not absent, f"The build made no code for {' and '.join(absent)}: CMakeLists.txt does not list it.")


@check(points=1, holds=("packages", "stamp-package"), doc=contract.INTERFACES_DOC)
@hint("Which tool installs what the generated code needs when it runs?", "Three tags, besides the generators'.")
def test_interface_manifest(workspace: Workspace) -> None:
    """package.xml of motor_guard_interfaces says that it holds messages, and what these need."""
    found = manifest.read(source_of(workspace, INTERFACES))
    group = "rosidl_interface_packages"
    expect(group in found.groups, f"package.xml does not say <member_of_group>{group}.", fraction=0.5)
    lacks = {"rosidl_default_runtime"} - found.needs("exec")
    expect(not lacks, "package.xml has no exec_depend on rosidl_default_runtime.", fraction=0.5)
    declared = "builtin_interfaces" in found.needs("build") & found.needs("exec")
    expect(declared, "package.xml has no depend on builtin_interfaces, whose Time the messages hold.", fraction=0.5)


@check(points=2, holds="packages", depends=("messages_are_generated",), doc=contract.PACKAGES_DOC)
@hint("entry_points={'console_scripts': ['thermometer = motor_guard.thermometer:main', ...]}")
@hint("install_scripts in setup.cfg says where programs go; ros2 pkg create has written it.")
def test_installs(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds motor_guard, and installs three programs where ros2 finds them."""
    require_built(builds, PACKAGE)
    found = look(workspace.install, PACKAGE)
    expect_executables(found.executables, found.misplaced, PROGRAMS)


@check(points=1, holds="dependencies", depends=("installs",), doc=contract.PACKAGES_DOC)
@hint("rosdep reads package.xml and nothing else: what is missing there is missing on every other machine.")
@hint("depend for what the nodes import, exec_depend for what the launch file imports.")
def test_dependencies(workspace: Workspace) -> None:
    """package.xml of motor_guard declares whatever its nodes and its launch file import."""
    source = source_of(workspace, PACKAGE)
    missing = imports.missing(source, manifest.read(source))["exec"]
    expect(not missing, f"{imports.say(missing)}: package.xml does not declare it.")
