"""Checks of the package that the student repairs: its faults are fixed, and its program works."""

from __future__ import annotations

import random
from collections.abc import Mapping

from autograder.checking import Diagnosis, Workspace, expect, group, hint
from autograder.checking.probes import imports, installed, packaging
from autograder.checks.ch01_package_structure.hidden.given_tests import ALARM, HINTS, expect_given_tests
from autograder.checks.ch01_package_structure.support import contract, robots
from autograder.checks.ch01_package_structure.support.assertions import (
    expect_built,
    expect_declared,
    expect_executable,
    expect_modules,
    expect_rosdep_key,
    expect_shared,
    read_manifest,
    source_of,
)

check = group("repair")
MISSING_AT_FIRST = 4  # undeclared at first: numpy and the three packages that the launch file imports


@check(points=2, covers="alarm-builds", doc=contract.COLCON)
@hint("Run colcon build --paths src/wall_alarm in ws and read the first line that says error.")
@hint("The marker is an empty file: resource/wall_alarm.")
def test_alarm_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds wall_alarm."""
    expect_built(builds, contract.WALL_ALARM)


@check(points=1, covers="alarm-runs", needs=("alarm_builds",), doc=contract.DEVELOP)
@hint("No executable found: in which folder of install/wall_alarm is the program?")
@hint("setup.cfg: install_scripts=$base/lib/wall_alarm under [install].")
def test_alarm_executable(installed_alarm: installed.Installed) -> None:
    """The program alarm is installed where `ros2 run` looks for it."""
    expect_executable(installed_alarm, contract.ALARM)


@check(points=2, covers="alarm-runs", needs=("alarm_builds",), doc=contract.SUBPACKAGES)
@hint("ModuleNotFoundError: No module named 'wall_alarm.nodes': was this module installed?")
@hint("packages=find_packages(exclude=['test']) in setup.py.")
def test_alarm_subpackages(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """All modules of wall_alarm are installed."""
    expect_modules(installed_alarm, source_of(workspace, contract.WALL_ALARM))


@check(points=1, covers="alarm-config", needs=("alarm_builds",), doc=contract.DEVELOP)
@hint("Look into install/wall_alarm/share/wall_alarm.", "The pattern ends in yml, but the file's name ends in yaml.")
def test_alarm_config(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """The configuration of wall_alarm is installed."""
    expect_shared(installed_alarm, source_of(workspace, contract.WALL_ALARM), contract.ALARM_CONFIG)


@check(points=2, covers="alarm-dependencies", doc=contract.ROSDEP)
@hint("In package.xml, numpy is called python3-numpy: this is its rosdep key, and pip uses another name.")
@hint("The launch file imports three packages; each is an <exec_depend>.")
def test_alarm_dependencies(workspace: Workspace) -> None:
    """package.xml of wall_alarm declares what the modules and the launch file import."""
    manifest = read_manifest(workspace, contract.WALL_ALARM)
    needed_imports = imports.imported(source_of(workspace, contract.WALL_ALARM), without=("test",))
    expect_declared(needed_imports, manifest.needs("exec"), MISSING_AT_FIRST)
    expect_rosdep_key(manifest.needs(), "numpy")


@check(points=1, covers="alarm-licence", needs=("alarm_builds",), doc=contract.REP_149)
@hint("Two files name the licence. Do they agree?", "license='Apache-2.0' in setup.py.")
def test_alarm_licence(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """package.xml and setup.py of wall_alarm both name the licence Apache-2.0."""
    licences = read_manifest(workspace, contract.WALL_ALARM).licences
    licence = packaging.licence(installed_alarm)
    expect(
        licences == (contract.LICENCE,) and licence == contract.LICENCE,
        f"The licence is {', '.join(licences) or 'missing'} in package.xml and {licence or 'missing'} in setup.py; it "
        f"should be {contract.LICENCE} in both.",
    )
    licence_classifiers = [name for name in installed_alarm.classifiers if name.startswith("License ::")]
    other_licences = [name for name in licence_classifiers if name not in contract.CLASSIFIERS]
    message = f"setup.py names the licence {licence}, but has other classifiers: {', '.join(other_licences)}."
    expect(not other_licences, message, fraction=0.5)


@check(points=1, covers="alarm-pytest", needs=("alarm_builds",), doc=contract.COLCON)
@hint("colcon test runs pytest only for a package whose setup.py names pytest.")
@hint("extras_require={'test': ['pytest']} works with every version of setuptools.")
def test_alarm_names_pytest(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """setup.py of wall_alarm names pytest so that colcon finds it."""
    packaging.expect_pytest(workspace, installed_alarm)


@check(
    points=2,
    covers=("alarm-runs", "alarm-given"),
    needs=("alarm_executable",),
    after=("alarm_subpackages",),
    doc=contract.CREATE,
)
@hint("What does ros2 run wall_alarm alarm print in a new shell, after source install/setup.bash?")
@hint("The given node was correct: use it unchanged.")
def test_alarm_sounds(workspace: Workspace, draw: random.Random) -> None:
    """The alarm goes off for something near, and not for something far away."""
    with robots.alarm(workspace) as harness:
        robots.expect_alarm(harness, round(draw.uniform(0.46, 0.48), 3), True)
        robots.expect_alarm(harness, round(draw.uniform(0.52, 0.54), 3), False)


@check(
    points=1,
    covers=("alarm-config", "alarm-given"),
    needs=("alarm_executable", "alarm_config"),
    after=("alarm_sounds",),
    doc=contract.DEVELOP,
)
@hint("The given configuration was correct: install it unchanged.", "distance: 0.8 means 0.8 m.")
def test_alarm_configured(workspace: Workspace, installed_alarm: installed.Installed, draw: random.Random) -> None:
    """With the installed configuration, the alarm goes off for something nearer than 0.8 m."""
    path = installed_alarm.prefix / "share" / installed_alarm.package / contract.ALARM_CONFIG
    with robots.alarm(workspace, "--params-file", str(path)) as harness:
        robots.expect_alarm(harness, round(draw.uniform(0.66, 0.76), 2), True)
        robots.expect_alarm(harness, round(draw.uniform(0.84, 0.98), 2), False)


@check(points=1, covers="alarm-given", needs=("alarm_builds",), doc=contract.COLCON)
@hint(*HINTS)
def test_alarm_given_tests(workspace: Workspace) -> None:
    """The tests given with wall_alarm, including the linter tests, detect a fault in a copy of the package."""
    expect_given_tests(workspace, ALARM)
