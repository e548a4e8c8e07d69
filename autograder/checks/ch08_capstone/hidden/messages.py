"""Step 3: the messages between the nodes, and the package that carries them."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checking import CheckFailed, Diagnosis, Workspace, expect, group, hint
from autograder.checking.probes import installed, manifest
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import INTERFACES
from autograder.checks.ch08_capstone.support.messages import CLEARANCE, HEALTH, Message, differences
from autograder.checks.ch08_capstone.support.sources import require_built, source_of

check = group("step_3", doc=contract.INTERFACES_DOC)
NEEDS = {
    "buildtool": ("ament_cmake", "rosidl_default_generators"),
    "exec": ("rosidl_default_runtime", "std_msgs"),
}
TABLES = ("Compare with the table of step 3, letter by letter; comments are yours.",)


@check(points=2, covers=("definitions", "clearance-header", "valid-field", "front", "left", "right"))
@hint(*TABLES)
def test_clearance_message(workspace: Workspace) -> None:
    """Clearance.msg has the fields of the contract, in its order, with its types."""
    _expect_like(workspace, CLEARANCE)


@check(points=2, covers=("definitions", "levels", "health-header", "level-field", "silent-field"))
@hint(*TABLES)
def test_health_message(workspace: Workspace) -> None:
    """Health.msg has the constants and fields of the contract, in its order, with its types."""
    _expect_like(workspace, HEALTH)


@check(points=2, covers=("interfaces-manifest", "interfaces-cmake"))
@hint('rosidl_generate_interfaces(${PROJECT_NAME} "msg/Clearance.msg" "msg/Health.msg" DEPENDENCIES std_msgs)')
@hint("package.xml: buildtool_depend on the generators, exec_depend on the runtime, and member_of_group.")
def test_interface_package(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds both messages, and the manifest declares what that takes."""
    require_built(builds, INTERFACES)
    shared = installed.look(workspace.install, INTERFACES).shared
    for name in (CLEARANCE.name, HEALTH.name):
        expect(
            f"msg/{name}.msg" in shared,
            f"The build made no code for msg/{name}.msg: does CMakeLists.txt list it, and end with ament_package()?",
        )
    found = manifest.read(source_of(workspace, INTERFACES))
    for kind, names in NEEDS.items():
        absent = [name for name in names if name not in found.needs(kind)]
        expect(not absent, f"package.xml has no {kind}_depend on {', '.join(absent)}.", fraction=0.5)
    expect(
        "rosidl_interface_packages" in found.groups,
        "package.xml does not say <member_of_group>rosidl_interface_packages</member_of_group>.",
        fraction=0.5,
    )


def _expect_like(workspace: Workspace, wanted: Message) -> None:
    wrong = differences(workspace, wanted)
    if wrong:
        total = len(wanted.fields) + len(wanted.constants)
        raise CheckFailed(" ".join(wrong[:3]), fraction=round(max(0.0, 1.0 - len(wrong) / total), 2) * 0.9)
