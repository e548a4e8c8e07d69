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
    "The generators build the package: use buildtool_depend. Its users need the runtime: use exec_depend.",
)


@check(points=2, covers="interfaces-manifest")
@hint(*HINTS)
def test_manifest(workspace: Workspace) -> None:
    """package.xml declares that CMake builds the package, and what the generators and the users need."""
    packages, _ = find_packages(workspace.root / "src")
    package_manifest = manifest.read(packages.get(INTERFACES, workspace.root / "src" / INTERFACES))
    mistakes = packaging.wrong_for_interfaces(package_manifest, USES)
    fraction = round(max(0.0, 1.0 - len(mistakes) / 7), 2)
    expect(not mistakes, f"In package.xml, {'; '.join(mistakes)}.", fraction=fraction)


@check(points=2, covers="interfaces-manifest", after=("readable",))
@hint("Run `colcon build --packages-select my_robot_interfaces` and read the first line with “error”.")
@hint("CMakeLists.txt must find each package that a definition uses, and name it after DEPENDENCIES.")
def test_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds my_robot_interfaces."""
    if builds[INTERFACES] is not OK:
        raise StudentError(builds[INTERFACES])


@check(points=2, covers="names-and-order", needs=("builds",))
@hint("Installing a .msg file generates no code. rosidl_generate_interfaces in CMakeLists.txt generates it.")
@hint("rosidl_generate_interfaces(${PROJECT_NAME} …) must name every definition, with its folder.")
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
            "the definition was installed, but no code was generated from it"
            if copied_paths
            else "CMakeLists.txt does not name the definition"
        )
        fraction = round(1.0 - len(absent) / len(contract.DEFINITIONS), 2)
        raise CheckFailed(f"There is no class for {', '.join(absent)}: {reason}.", fraction=fraction)


@check(points=1, covers="interfaces-manifest", needs=("builds",))
@hint("Call ament_package() in the last line of CMakeLists.txt, after everything that it depends on.")
def test_indexed(workspace: Workspace) -> None:
    """The ament index contains the package, so that ros2 and other packages find it."""
    installation = installed.inspect_package(workspace.install, INTERFACES)
    expect(
        installation.marker,
        "share/ament_index does not contain my_robot_interfaces: CMakeLists.txt does not call ament_package().",
    )
    expect("package.xml" in installation.shared, "package.xml was not installed. ament_package() installs it.")


def _module_name(name: str) -> str:
    """Return the module of a type as rosidl names it, such as robot_status for RobotStatus."""
    return "".join(
        f"_{letter.lower()}" if letter.isupper() and index else letter.lower() for index, letter in enumerate(name)
    )
