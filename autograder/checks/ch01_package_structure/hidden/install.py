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
@hint("Is there a syntax error in setup.py, or does data_files name a missing file? colcon quotes Python's error.")
def test_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds square_dance."""
    expect_built(builds, contract.SQUARE_DANCE)


@check(points=1, covers=("files", "empty-files"), needs=("builds",), doc=contract.DEVELOP)
@hint("ros2 finds a package by an empty file with the package's name, in share/ament_index/resource_index/packages.")
@hint(
    "In data_files, pair that folder with ['resource/' + package_name], 'share/' + package_name with ['package.xml']."
)
def test_marker(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """setup.py installs package.xml and the marker of the package; the marker and each __init__.py are empty."""
    expect(
        installed_dance.marker,
        "square_dance is not in the ament index, so ros2 run would not find the package.",
    )
    packaging.expect_installs_itself(installed_dance)
    expect_empty(source_of(workspace, contract.SQUARE_DANCE), contract.EMPTY_FILES)


@check(points=1, covers="program", needs=("builds",), doc=contract.DEVELOP)
@hint("console_scripts in setup.py lists the programs; setup.cfg says where they are installed.")
@hint("dancer = square_dance.nodes.dancer:main, and install_scripts=$base/lib/square_dance under [install].")
def test_executable(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """The program dancer is installed where `ros2 run` looks for it, also with --symlink-install."""
    expect_executable(installed_dance, contract.DANCER)
    expect_develop(source_of(workspace, contract.SQUARE_DANCE), contract.SQUARE_DANCE)


@check(points=2, covers=("modules", "empty-files"), needs=("builds",), doc=contract.SUBPACKAGES)
@hint("packages=[package_name] installs that one folder, not the folders in it.")
@hint("find_packages takes a folder for a package if it contains an __init__.py.")
def test_subpackages(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """All modules of square_dance are installed, including those in nodes and utils."""
    expect_modules(installed_dance, source_of(workspace, contract.SQUARE_DANCE))


@check(points=1, covers="files", needs=("builds",), doc=contract.DEVELOP)
@hint("setuptools installs launch files by data_files.", "glob('launch/*.launch.py') returns the list of files.")
def test_launch_file(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """The launch file of square_dance is installed in share/square_dance/launch."""
    expect_shared(installed_dance, source_of(workspace, contract.SQUARE_DANCE), contract.DANCE_LAUNCH)


@check(points=1, covers="files", needs=("builds",), doc=contract.DEVELOP)
@hint("setuptools installs the configuration by data_files.", "glob('config/*.yaml') returns the list of files.")
def test_config(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """The configuration of square_dance is installed in share/square_dance/config."""
    expect_shared(installed_dance, source_of(workspace, contract.SQUARE_DANCE), contract.DANCE_CONFIG)


@check(points=1, covers="same-facts", needs=("builds",), after=("manifest",), doc=contract.DEVELOP)
@hint("package.xml and setup.py both contain the version, the licence and the maintainer.")
@hint("license='Apache-2.0' in setup.py is the same text as in package.xml.")
def test_same_facts(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """setup.py of square_dance has the same version, licence and maintainer as package.xml."""
    packaging.expect_same_facts(installed_dance, read_manifest(workspace, contract.SQUARE_DANCE))


@check(points=1, covers="pytest", needs=("builds",), doc=contract.COLCON)
@hint("colcon test runs pytest only for a package whose setup.py names pytest.")
@hint("extras_require={'test': ['pytest']} works with every version of setuptools.")
def test_names_pytest(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """setup.py of square_dance names pytest so that colcon finds it."""
    packaging.expect_pytest(workspace, installed_dance)


@check(
    points=2,
    covers=("modules", "files"),
    needs=("builds",),
    after=("subpackages", "launch_file", "config"),
    doc=contract.SUBPACKAGES,
)
@hint("A list of names written by hand is wrong as soon as somebody adds a file.")
@hint("find_packages(...) and glob(...) find the files that exist when the package is built.")
def test_grows(extended: ExtendedPackage) -> None:
    """A new subpackage, launch file and configuration are installed without a change to setup.py."""
    missing = extended.missing
    expect(not missing, f"colcon did not install the new {', '.join(missing)}.", fraction=1.0 - len(missing) / 4)
    given_files = contract.DANCE_LAUNCH, contract.DANCE_CONFIG
    lost_files = [name for name in given_files if extended.installation.read(name) is None]
    message = f"After new files were added, colcon no longer installed {' and '.join(lost_files)}."
    expect(not lost_files, message, fraction=0.5)


@check(points=1, covers=("tests-stay", "modules", "program"), needs=("builds",), doc=contract.SUBPACKAGES)
@hint("find_packages() takes test/ for a package of yours if it contains an __init__.py.", "exclude=['test']")
@hint("Did you copy setup.py from another package? Remove the lines that name the programs of that package.")
def test_tests_stay(extended: ExtendedPackage) -> None:
    """Only the module square_dance is installed, and no module test, even if test/ contains an __init__.py."""
    modules = extended.installation.modules
    test_modules = sorted(name for name in modules if name.split(".")[0] == "test")
    message = f"setup.py installs {', '.join(test_modules[:2])}, which would hide Python's own module test."
    expect(not test_modules, message)
    other_modules = sorted(name for name in modules if name.split(".")[0] != contract.SQUARE_DANCE)
    message = f"setup.py installs {', '.join(other_modules[:2])}; it should install only {contract.SQUARE_DANCE}."
    expect(not other_modules, message, fraction=0.5)
    for name, module in extended.installation.programs.items():
        if name != contract.DANCER:  # other checks test the dancer's module
            message = (
                f"The program {name} is installed, but its module {module} is not: remove {name} from console_scripts."
            )
            expect(module in modules, message, fraction=0.5)


@check(points=1, covers="given", needs=("builds",), doc=contract.COLCON)
@hint(*HINTS)
def test_given_tests(workspace: Workspace) -> None:
    """The tests given with square_dance, including the linter tests, detect a fault in a copy of the package."""
    expect_given_tests(workspace, DANCE)
