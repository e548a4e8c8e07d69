"""Checks of what colcon installs from the package that the student makes: setup.py, setup.cfg and the marker."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checking import Diagnosis, Workspace, expect, group, hint
from autograder.checking.probes import installed, packaging
from autograder.checks.ch01_package_structure.hidden.given_tests import DANCE, HINTS, expect_given_tests
from autograder.checks.ch01_package_structure.support import contract
from autograder.checks.ch01_package_structure.support.added_files import ExtendedPackage
from autograder.checks.ch01_package_structure.support.assertions import (
    expect_built,
    expect_develop,
    expect_empty,
    expect_executable,
    expect_modules,
    expect_shared,
    read_manifest,
    source_of,
)

check = group("install")


@check(points=2, covers="builds", doc=contract.COLCON)
@hint("Run colcon build in ws and read the first line that says error.")
@hint("A syntax error in setup.py, a file that data_files names and that is not there: colcon quotes Python.")
def test_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds square_dance."""
    expect_built(builds, contract.SQUARE_DANCE)


@check(points=1, covers=("files", "empty-files"), needs=("builds",), doc=contract.DEVELOP)
@hint("ros2 finds a package by an empty file of its name in share/ament_index/resource_index/packages.")
@hint("data_files: that folder with ['resource/' + package_name], 'share/' + package_name with ['package.xml'].")
def test_marker(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """setup.py installs the marker by which ROS finds the package, and package.xml; what should be empty is."""
    expect(
        installed_dance.marker,
        "The ament index does not know square_dance: ros2 run would say that the package is not found.",
    )
    packaging.expect_installs_itself(installed_dance)
    expect_empty(source_of(workspace, contract.SQUARE_DANCE), contract.EMPTY_FILES)


@check(points=1, covers="program", needs=("builds",), doc=contract.DEVELOP)
@hint("console_scripts in setup.py says which programs there are, setup.cfg says where they go.")
@hint("dancer = square_dance.nodes.dancer:main, and install_scripts=$base/lib/square_dance under [install].")
def test_executable(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """The program dancer lies where `ros2 run` looks for it, also with --symlink-install."""
    expect_executable(installed_dance, contract.DANCER)
    expect_develop(source_of(workspace, contract.SQUARE_DANCE), contract.SQUARE_DANCE)


@check(points=2, covers=("modules", "empty-files"), needs=("builds",), doc=contract.SUBPACKAGES)
@hint("packages=[package_name] means one folder, not those in it.")
@hint("find_packages takes a folder for a package when there is an __init__.py in it.")
def test_subpackages(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """All of its modules are installed, those in nodes and utils, too."""
    expect_modules(installed_dance, source_of(workspace, contract.SQUARE_DANCE))


@check(points=1, covers="files", needs=("builds",), doc=contract.DEVELOP)
@hint("Launch files are data to setuptools: data_files.", "glob('launch/*.launch.py') gives the list of files.")
def test_launch_file(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """Its launch file is installed in share/square_dance/launch."""
    expect_shared(installed_dance, source_of(workspace, contract.SQUARE_DANCE), contract.DANCE_LAUNCH)


@check(points=1, covers="files", needs=("builds",), doc=contract.DEVELOP)
@hint("Configuration is data to setuptools: data_files.", "glob('config/*.yaml') gives the list of files.")
def test_config(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """Its configuration is installed in share/square_dance/config."""
    expect_shared(installed_dance, source_of(workspace, contract.SQUARE_DANCE), contract.DANCE_CONFIG)


@check(points=1, covers="same-facts", needs=("builds",), after=("manifest",), doc=contract.DEVELOP)
@hint("package.xml and setup.py each say the version, the licence and the maintainer.")
@hint("license='Apache-2.0' in setup.py is the licence in the form of package.xml.")
def test_same_facts(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """setup.py names the version, the licence and the maintainer that package.xml names."""
    packaging.expect_same_facts(installed_dance, read_manifest(workspace, contract.SQUARE_DANCE))


@check(points=1, covers="pytest", needs=("builds",), doc=contract.COLCON)
@hint("colcon test runs pytest only for a package that says that it uses it.")
@hint("extras_require={'test': ['pytest']} says so to every setuptools.")
def test_names_pytest(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """setup.py says, in a way that colcon understands, that its tests are run by pytest."""
    packaging.expect_pytest(workspace, installed_dance)


@check(
    points=2,
    covers=("modules", "files"),
    needs=("builds",),
    after=("subpackages", "launch_file", "config"),
    doc=contract.SUBPACKAGES,
)
@hint("A list of names written by hand is wrong on the day when somebody adds a file.")
@hint("find_packages(...) and glob(...) look at what is there when the package is built.")
def test_grows(extended: ExtendedPackage) -> None:
    """A new subpackage, launch file and configuration are installed without a change of setup.py."""
    missing = extended.missing
    expect(not missing, f"The new {', '.join(missing)} stayed behind.", fraction=1.0 - len(missing) / 4)
    given_files = contract.DANCE_LAUNCH, contract.DANCE_CONFIG
    lost_files = [name for name in given_files if extended.installation.read(name) is None]
    expect(not lost_files, f"When a new file lay beside it, {' and '.join(lost_files)} stayed behind.", fraction=0.5)


@check(points=1, covers=("tests-stay", "modules", "program"), needs=("builds",), doc=contract.SUBPACKAGES)
@hint("find_packages() takes test/ for a package of yours when there is an __init__.py in it.", "exclude=['test']")
@hint("A setup.py copied from another package still names its programs: remove the lines of those that are not yours.")
def test_tests_stay(extended: ExtendedPackage) -> None:
    """Nothing is installed beside its module: no module called test, also with an __init__.py beside the tests."""
    modules = extended.installation.modules
    strays = sorted(name for name in modules if name.split(".")[0] == "test")
    expect(not strays, f"{', '.join(strays[:2])} was installed: it would hide Python's own module test.")
    strays = sorted(name for name in modules if name.split(".")[0] != contract.SQUARE_DANCE)
    expect(not strays, f"{', '.join(strays[:2])} was installed, a module beside {contract.SQUARE_DANCE}.", fraction=0.5)
    for name, module in extended.installation.programs.items():
        if name != contract.DANCER:  # other checks test the dancer's module
            message = (
                f"The program {name} is installed, and its module {module} is not: remove it from console_scripts."
            )
            expect(module in modules, message, fraction=0.5)


@check(points=1, covers="given", needs=("builds",), doc=contract.COLCON)
@hint(*HINTS)
def test_given_tests(workspace: Workspace) -> None:
    """The tests given with square_dance, the linters' too, notice a fault that is put into a copy of the package."""
    expect_given_tests(workspace, DANCE)
