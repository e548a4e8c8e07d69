"""Steps 1 and 3: the build of the two packages, and the definitions of the messages."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checking import Diagnosis, Workspace, check, expect, hint
from autograder.checking.probes import imports, installed, manifest
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import INTERFACES, PACKAGE, PROGRAMS
from autograder.checks.ch08_capstone.support.messages import CLEARANCE, HEALTH, differences
from autograder.checks.ch08_capstone.support.sources import require_built, source_of


@check(points=1, covers=("installs", "imports"), group="step_1", doc=contract.PACKAGES_DOC)
@hint("The tags have to be in this order: name, version, description, maintainer, license, dependencies, export.")
@hint("setup(name=..., version=..., packages=find_packages(exclude=['test']), entry_points={...}, ...)")
def test_package(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Step 1: robot_navigation_tutorial builds, installs three executables, and declares its imports."""
    package_xml = manifest.read(source_of(workspace, PACKAGE))
    require_built(builds, PACKAGE)
    executables = installed.inspect_package(workspace.install, PACKAGE).executables
    missing_programs = [name for name in PROGRAMS if name not in executables]
    expect(
        not missing_programs,
        f"The build did not install the executable {' or '.join(missing_programs)}. "
        f"Installed executables: {', '.join(executables) or 'none'}.",
    )
    missing = imports.missing(source_of(workspace, PACKAGE), package_xml)
    expect(not missing["exec"], f"{imports.describe(missing['exec'])}: not declared in package.xml.")


@check(points=1, covers="definitions", group="step_3", doc=contract.INTERFACES_DOC)
@hint("Compare with the tables of step 3, letter by letter.", "float32 front, bool valid, std_msgs/Header header.")
def test_definitions(workspace: Workspace) -> None:
    """Step 3: both messages have the fields and constants of the contract."""
    errors = [*differences(workspace, CLEARANCE), *differences(workspace, HEALTH)]
    expect(not errors, " ".join(errors[:3]))


@check(points=1, covers="interfaces-manifest", group="step_3", doc=contract.INTERFACES_DOC)
@hint('rosidl_generate_interfaces(${PROJECT_NAME} "msg/Clearance.msg" "msg/Health.msg" DEPENDENCIES std_msgs)')
@hint("Start with find_package for ament_cmake, rosidl_default_generators and std_msgs; end with ament_package().")
def test_interfaces_build(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Step 3: colcon builds the package of the messages."""
    require_built(builds, INTERFACES)
    shared_files = installed.inspect_package(workspace.install, INTERFACES).shared
    missing_names = [name for name in ("Clearance", "Health") if f"msg/{name}.msg" not in shared_files]
    expect(
        not missing_names,
        f"The build generated no code for {' or '.join(missing_names)}: does CMakeLists.txt list both messages?",
    )
