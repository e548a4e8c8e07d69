"""Checks of the interface package: its manifest and its build."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checking import OK, CheckFailed, Diagnosis, StudentError, Workspace, expect, find_packages, group, hint
from autograder.checking.probes import installed, manifest, packaging
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.contract import INTERFACES

check = group("package", doc=contract.DEFINE)
# The packages that definitions use, each with a definition that uses it.
USES = {"std_msgs": "RobotStatus", "action_msgs": "DriveDistance"}
HINTS = (
    "Compare it with the package.xml of chapter_interfaces in this chapter.",
    "The generators build the package: buildtool_depend. Its users need the runtime: exec_depend.",
)


@check(points=2, covers="interfaces-manifest")
@hint(*HINTS)
def test_manifest(workspace: Workspace) -> None:
    """package.xml says that the package is built by CMake and what the generators and the users need."""
    packages, _ = find_packages(workspace.root / "src")
    package_manifest = manifest.read(packages.get(INTERFACES, workspace.root / "src" / INTERFACES))
    wrong = packaging.wrong_for_interfaces(package_manifest, USES)
    expect(not wrong, f"In package.xml {'; '.join(wrong)}.", fraction=round(max(0.0, 1.0 - len(wrong) / 7), 2))


@check(points=2, covers="interfaces-manifest", after=("readable",))
@hint("Run `colcon build --packages-select my_robot_interfaces` and read the first line with “error”.")
@hint("Each package in a definition is found in CMakeLists.txt, and named after DEPENDENCIES.")
def test_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds my_robot_interfaces."""
    if builds[INTERFACES] is not OK:
        raise StudentError(builds[INTERFACES])


@check(points=2, covers="names-and-order", needs=("builds",))
@hint("Installing a .msg file generates nothing: rosidl_generate_interfaces in CMakeLists.txt does.")
@hint("rosidl_generate_interfaces(${PROJECT_NAME} …) names every definition, with its folder.")
def test_generated(workspace: Workspace) -> None:
    """The build generates Python classes from all three definitions."""
    installation = installed.inspect_package(workspace.install, INTERFACES)
    absent = []
    for definition in contract.DEFINITIONS:
        kind, name = definition.path.split(".")[0].split("/")
        if f"{INTERFACES}.{kind}._{_module_name(name)}" not in installation.modules:
            absent.append(definition.path)
    if absent:
        copied_paths = [path for path in absent if path in installation.shared]
        reason = (
            "the text was installed, but nothing was generated from it"
            if copied_paths
            else "CMakeLists.txt does not name it"
        )
        fraction = round(1.0 - len(absent) / len(contract.DEFINITIONS), 2)
        raise CheckFailed(f"There is no class for {', '.join(absent)}: {reason}.", fraction=fraction)


@check(points=1, covers="interfaces-manifest", needs=("builds",))
@hint("ament_package() is the last line of CMakeLists.txt, after everything that it has to know.")
def test_indexed(workspace: Workspace) -> None:
    """The ament index knows the package, so that ros2 and other packages find it."""
    installation = installed.inspect_package(workspace.install, INTERFACES)
    expect(
        installation.marker,
        "share/ament_index has no my_robot_interfaces: CMakeLists.txt does not call ament_package().",
    )
    expect("package.xml" in installation.shared, "package.xml was not installed, which ament_package() does.")


def _module_name(name: str) -> str:
    """Return the module of a type as rosidl names it, such as robot_status for RobotStatus."""
    return "".join(
        f"_{letter.lower()}" if letter.isupper() and index else letter.lower() for index, letter in enumerate(name)
    )
