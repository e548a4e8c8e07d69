"""Checks of what colcon, rosdep and ros2 run find in the two packages."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checking import Diagnosis, Workspace, expect, group, hint
from autograder.checking.probes import imports, installed, packaging
from autograder.checks.ch01_package_structure.support import contract, robots
from autograder.checks.ch01_package_structure.support.added_files import extend
from autograder.checks.ch01_package_structure.support.assertions import (
    expect_built,
    expect_declared,
    expect_executable,
    expect_licence,
    expect_manifest,
    expect_modules,
    expect_shared,
    source_of,
)

check = group("packages")


@check(points=1, covers=("manifest", "build-type"), doc=contract.CREATE)
@hint("Name, version, description, maintainer, licence and <export><build_type>: look at what ros2 pkg create wrote.")
@hint('The tags belong between <package format="3"> and </package>; <export> is the last one.')
def test_manifest(workspace: Workspace) -> None:
    """square_dance/package.xml describes a Python package."""
    expect_manifest(workspace, contract.SQUARE_DANCE)


@check(points=1, covers="licence", after=("manifest",), doc=contract.REP_149)
@hint("A licence is named by its SPDX identifier.", "<license>Apache-2.0</license>")
def test_licence(workspace: Workspace) -> None:
    """package.xml names the licence Apache-2.0."""
    expect_licence(workspace, contract.SQUARE_DANCE)


@check(points=1, covers="dependencies", after=("manifest",), doc=contract.ROSDEP)
@hint("Declare what each file in square_dance imports, except for Python's standard library and the package itself.")
@hint("<depend> for what the node imports, <exec_depend> for the launch file, <test_depend> for test/.")
def test_dependencies(workspace: Workspace) -> None:
    """package.xml of square_dance declares whatever the package's files import, for the run or for the tests."""
    manifest, source = expect_manifest(workspace, contract.SQUARE_DANCE), source_of(workspace, contract.SQUARE_DANCE)
    expect_declared(imports.imported(source, without=("test",)), manifest.needs("exec"))
    expect_declared(imports.imported(source), manifest.needs("exec", "test"))


@check(points=1, covers="builds", doc=contract.COLCON)
@hint("Run colcon build in ws and read the first line that says error.")
@hint("The error can't copy 'resource/square_dance' means that the empty marker file is missing.")
def test_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds square_dance."""
    expect_built(builds, contract.SQUARE_DANCE)


@check(points=1, covers=("program", "given"), needs=("builds",), doc=contract.DEVELOP)
@hint("Was a module not installed? See packages= in setup.py. Was the program not found? See entry_points.")
@hint("find_packages finds folders that have an __init__.py; setup.cfg says where programs are installed.")
def test_dancer(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """`ros2 run square_dance dancer` finds the program with all of its modules, and the robot dances."""
    expect_executable(installed_dance, contract.DANCER)
    expect_modules(installed_dance, source_of(workspace, contract.SQUARE_DANCE))
    with robots.dancer(workspace) as harness:
        robots.expect_dance(harness, 1.0)


@check(points=1, covers="files", needs=("builds",), doc=contract.DEVELOP)
@hint("Each entry of data_files is a pair: a folder below the install prefix, and a list of files.")
@hint("('share/' + package_name + '/launch', glob('launch/*.launch.py')); config works the same way.")
def test_shared(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """The launch file and the configuration of square_dance are installed."""
    for name in (contract.DANCE_LAUNCH, contract.DANCE_CONFIG):
        expect_shared(installed_dance, source_of(workspace, contract.SQUARE_DANCE), name)


@check(points=1, covers=("same-facts", "pytest"), needs=("builds",), after=("manifest",), doc=contract.DEVELOP)
@hint("Compare version, license and maintainer_email in setup.py with package.xml, letter by letter.")
@hint("extras_require={'test': ['pytest']} tells colcon that pytest runs the tests.")
def test_facts(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """setup.py of square_dance has the same version, licence and e-mail as package.xml, and names pytest."""
    packaging.expect_same_facts(installed_dance, expect_manifest(workspace, contract.SQUARE_DANCE))
    packaging.expect_pytest(workspace, installed_dance)


@check(points=1, covers=("modules", "files"), needs=("builds",), after=("dancer", "shared"), doc=contract.SUBPACKAGES)
@hint("A list of names written by hand does not contain a file that is added later.")
@hint("find_packages(exclude=['test']), glob('launch/*.launch.py') and glob('config/*.yaml').")
def test_grows(workspace: Workspace) -> None:
    """A launch file, a configuration and a subpackage that are added to square_dance later are installed, too."""
    missing = extend(workspace, "minuet").missing
    expect(not missing, f"colcon did not install the new {', '.join(missing)}.")


@check(points=1, covers="alarm-builds", doc=contract.COLCON)
@hint("Run colcon build --paths src/wall_alarm in ws and read the first line that says error.")
@hint("The marker is an empty file: resource/wall_alarm.")
def test_alarm_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds wall_alarm."""
    expect_built(builds, contract.WALL_ALARM)


@check(points=1, covers="alarm-runs", needs=("alarm_builds",), doc=contract.DEVELOP)
@hint("Fix one error, then build again. What does ros2 run wall_alarm alarm print now?")
@hint("No executable found: see setup.cfg. No module named ...: see packages= in setup.py.")
def test_alarm_runs(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """`ros2 run wall_alarm alarm` finds the program, and its alarm goes off."""
    expect_executable(installed_alarm, contract.ALARM)
    expect_modules(installed_alarm, source_of(workspace, contract.WALL_ALARM))
    with robots.alarm(workspace) as harness:
        robots.expect_alarm(harness, 0.3, True)
        robots.expect_alarm(harness, 3.0, False)


@check(points=1, covers="alarm-dependencies", doc=contract.ROSDEP)
@hint("In package.xml, numpy is called python3-numpy: this is its rosdep key, and pip uses another name.")
@hint("The launch file imports three packages; each is an <exec_depend>.")
def test_alarm_dependencies(workspace: Workspace) -> None:
    """package.xml of wall_alarm declares whatever the package's files import, for the run or for the tests."""
    manifest, source = expect_manifest(workspace, contract.WALL_ALARM), source_of(workspace, contract.WALL_ALARM)
    expect_declared(imports.imported(source, without=("test",)), manifest.needs("exec"))
    expect_declared(imports.imported(source), manifest.needs("exec", "test"))


@check(
    points=1,
    covers=("alarm-licence", "alarm-config", "alarm-pytest"),
    needs=("alarm_builds",),
    after=("alarm_dependencies",),
    doc=contract.DEVELOP,
)
@hint("<license> in package.xml and license= in setup.py should both be Apache-2.0.")
@hint("data_files installs config/*.yaml in share/wall_alarm/config; extras_require names pytest.")
def test_alarm_facts(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """wall_alarm names Apache-2.0 in package.xml and setup.py, names pytest, and installs its configuration."""
    expect_licence(workspace, contract.WALL_ALARM)
    licence = packaging.licence(installed_alarm)
    expect(
        licence == contract.LICENCE,
        f"In setup.py, the licence is {licence or 'missing'}; it should be {contract.LICENCE}.",
    )
    expect_shared(installed_alarm, source_of(workspace, contract.WALL_ALARM), contract.ALARM_CONFIG)
    packaging.expect_pytest(workspace, installed_alarm)
