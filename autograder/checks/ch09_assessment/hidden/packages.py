"""Question 3: the messages, and the declarations and installed files of the two packages."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checking import OK, Diagnosis, Workspace, expect, group, hint
from autograder.checking.probes import imports, installed, manifest, packaging
from autograder.checks.ch09_assessment.support import contract
from autograder.checks.ch09_assessment.support.contract import INTERFACES, PACKAGE, PROGRAMS
from autograder.checks.ch09_assessment.support.definitions import expect_definitions
from autograder.checks.ch09_assessment.support.robot import expect_executables, require_built, source_of

check = group("packages")


@check(points=2, covers=("temperature", "decision"), doc=contract.INTERFACES_DOC)
@hint("Compare with the table of the messages, letter by letter.", "The order of the fields counts, too.")
@hint("The fields have no defaults: write no value after the name of a field.")
def test_definitions(workspace: Workspace) -> None:
    """Both messages have the fields of the contract."""
    expect_definitions(workspace)


@check(points=2, covers="packages", after=("definitions",), doc=contract.INTERFACES_DOC)
@hint('rosidl_generate_interfaces(${PROJECT_NAME} "msg/Decision.msg" "msg/Temperature.msg" DEPENDENCIES ...)')
@hint("find_package for what you use; in package.xml a buildtool_depend on the generators, and member_of_group.")
def test_messages_are_generated(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds motor_guard_interfaces, with both messages."""
    require_built(builds, INTERFACES)
    shared = installed.inspect_package(workspace.install, INTERFACES).shared
    missing_paths = [path for path in contract.MESSAGES if path not in shared]
    expect(
        not missing_paths, f"The build generated no code for {' and '.join(missing_paths)}: list it in CMakeLists.txt."
    )


@check(points=1, covers=("interfaces-manifest", "licence", "stamp-package"), doc=contract.INTERFACES_DOC)
@hint("Which tool installs what the generated code needs when it runs?")
@hint("Two buildtool_depends, a depend, an exec_depend, a member_of_group, and the build type, as in 03_interfaces.")
def test_interface_manifest(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """motor_guard_interfaces declares its group, its dependencies and its licence, and is in the ament index."""
    package_manifest = manifest.read(source_of(workspace, INTERFACES))
    mistakes = packaging.wrong_for_interfaces(package_manifest, {"builtin_interfaces": "Temperature"})
    expect(not mistakes, f"In package.xml, {'; '.join(mistakes)}.", fraction=0.5)
    _expect_licence(package_manifest)
    if builds[INTERFACES] is OK:
        message = f"The ament index does not contain {INTERFACES}: CMakeLists.txt does not call ament_package()."
        expect(installed.inspect_package(workspace.install, INTERFACES).marker, message, fraction=0.5)


@check(points=2, covers="packages", after=("messages_are_generated",), doc=contract.PACKAGES_DOC)
@hint("entry_points={'console_scripts': ['thermometer = motor_guard.thermometer:main', ...]}")
@hint("install_scripts in setup.cfg sets where programs are installed. ros2 pkg create writes it.")
def test_installs(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds motor_guard, and installs three programs where ros2 finds them."""
    require_built(builds, PACKAGE)
    installation = installed.inspect_package(workspace.install, PACKAGE)
    expect_executables(installation.executables, installation.misplaced, PROGRAMS)


@check(
    points=1,
    covers=("dependencies", "licence", "same-facts", "set-up", "test-depends"),
    after=("installs",),
    doc=contract.PACKAGES_DOC,
)
@hint("rosdep reads only package.xml: a dependency that is missing there is missing on every other machine.")
@hint("depend for what the nodes import, exec_depend for what the launch file imports.")
@hint("setup.py, as ros2 pkg create writes it, names the marker, package.xml and pytest. Keep these lines.")
def test_dependencies(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """package.xml of motor_guard declares its dependencies and licence. setup.py agrees with it, and installs it."""
    require_built(builds, PACKAGE)
    source = source_of(workspace, PACKAGE)
    package_manifest, installation = manifest.read(source), installed.inspect_package(workspace.install, PACKAGE)
    missing = imports.missing(source, package_manifest)["exec"]
    expect(not missing, f"{imports.describe(missing)}: package.xml does not declare it.")
    absent_names = [name for name in contract.TEST_DEPENDENCIES if name not in package_manifest.needs("test")]
    expect(not absent_names, f"package.xml has no test_depend on {', '.join(absent_names)}.", fraction=0.5)
    _expect_licence(package_manifest)
    packaging.expect_same_facts(installation, package_manifest, fraction=0.5)
    packaging.expect_installs_itself(installation)
    packaging.expect_pytest(workspace, installation, fraction=0.5)
    name = installation.setup_name
    expect(name == PACKAGE, f"The name is {name} in setup.py and {PACKAGE} in package.xml.", fraction=0.5)
    modules = {module.rpartition(".")[2] for module in installation.modules}
    absent_names = [name for name in PROGRAMS if name not in modules]
    message = (
        f"Modules that are not installed: {', '.join(absent_names)}. Each program is main in the module of its name."
    )
    expect(not absent_names, message, fraction=0.5)


def _expect_licence(package_manifest: manifest.Manifest) -> None:
    licences = ", ".join(package_manifest.licences)
    message = (
        f"package.xml of {package_manifest.name} has the licence {licences or 'none'} instead of {contract.LICENCE}."
    )
    expect(licences == contract.LICENCE, message, fraction=0.5)
