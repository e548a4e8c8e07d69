"""Step 3: the messages between the nodes, and the package that defines them."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checking import CheckFailed, Diagnosis, Workspace, expect, group, hint
from autograder.checking.probes import installed, manifest
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import INTERFACES
from autograder.checks.ch08_capstone.support.messages import CLEARANCE, HEALTH, ExpectedMessage, differences
from autograder.checks.ch08_capstone.support.sources import require_built, source_of

check = group("step_3", doc=contract.INTERFACES_DOC)
DEPENDENCIES = {
    "buildtool": ("ament_cmake", "rosidl_default_generators"),
    "exec": ("rosidl_default_runtime",),
}
DEFINITION_HINTS = ("Compare with the table of step 3, letter by letter; comments are up to you.",)


@check(points=2, covers=("definitions", "clearance-header", "valid-field", "front", "left", "right"))
@hint(*DEFINITION_HINTS)
def test_clearance_message(workspace: Workspace) -> None:
    """Clearance.msg has the fields of the contract, in the same order and with the same types."""
    _expect_definition(workspace, CLEARANCE)


@check(points=2, covers=("definitions", "levels", "health-header", "level-field", "silent-field"))
@hint(*DEFINITION_HINTS)
def test_health_message(workspace: Workspace) -> None:
    """Health.msg has the constants and fields of the contract, in the same order and with the same types."""
    _expect_definition(workspace, HEALTH)


@check(points=2, covers=("interfaces-manifest", "interfaces-cmake"))
@hint('rosidl_generate_interfaces(${PROJECT_NAME} "msg/Clearance.msg" "msg/Health.msg" DEPENDENCIES std_msgs)')
@hint("package.xml: buildtool_depend on the generators, exec_depend on the runtime, and member_of_group.")
def test_interface_package(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds both messages, and the manifest declares what their build and their users need."""
    require_built(builds, INTERFACES)
    shared_files = installed.inspect_package(workspace.install, INTERFACES).shared
    for name in (CLEARANCE.name, HEALTH.name):
        expect(
            f"msg/{name}.msg" in shared_files,
            f"The build generated no code for msg/{name}.msg: does CMakeLists.txt list it and call ament_package()?",
        )
    package_xml = manifest.read(source_of(workspace, INTERFACES))
    for kind, names in DEPENDENCIES.items():
        missing_names = [name for name in names if name not in package_xml.needs(kind)]
        expect(not missing_names, f"package.xml has no {kind}_depend on {', '.join(missing_names)}.", fraction=0.5)
    is_declared = "std_msgs" in package_xml.needs("build") & package_xml.needs("exec")
    expect(is_declared, "package.xml has no depend on std_msgs.", fraction=0.5)
    expect(
        "rosidl_interface_packages" in package_xml.groups,
        "package.xml does not contain <member_of_group>rosidl_interface_packages</member_of_group>.",
        fraction=0.5,
    )


def _expect_definition(workspace: Workspace, expected: ExpectedMessage) -> None:
    errors = differences(workspace, expected)
    if errors:
        total = len(expected.fields) + len(expected.constants)
        raise CheckFailed(" ".join(errors[:3]), fraction=round(max(0.0, 1.0 - len(errors) / total), 2) * 0.9)
