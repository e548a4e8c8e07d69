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
@hint("No executable found: look for the program in install/wall_alarm, and see where it is.")
@hint("setup.cfg: install_scripts=$base/lib/wall_alarm under [install].")
def test_alarm_executable(installed_alarm: installed.Installed) -> None:
    """The program alarm lies where `ros2 run` looks for it."""
    expect_executable(installed_alarm, contract.ALARM)


@check(points=2, covers="alarm-runs", needs=("alarm_builds",), doc=contract.SUBPACKAGES)
@hint("ModuleNotFoundError: No module named 'wall_alarm.nodes': was it installed?")
@hint("packages=find_packages(exclude=['test']) in setup.py.")
def test_alarm_subpackages(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """All of its modules are installed."""
    expect_modules(installed_alarm, source_of(workspace, contract.WALL_ALARM))


@check(points=1, covers="alarm-config", needs=("alarm_builds",), doc=contract.DEVELOP)
@hint("Look into install/wall_alarm/share/wall_alarm.", "The pattern says yml, the file is called yaml.")
def test_alarm_config(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """Its configuration is installed."""
    expect_shared(installed_alarm, source_of(workspace, contract.WALL_ALARM), contract.ALARM_CONFIG)


@check(points=2, covers="alarm-dependencies", doc=contract.ROSDEP)
@hint("numpy's name in package.xml is python3-numpy: rosdep's key, not pip's.")
@hint("The launch file imports three packages; each is an <exec_depend>.")
def test_alarm_dependencies(workspace: Workspace) -> None:
    """package.xml declares what its modules and its launch file import."""
    manifest = read_manifest(workspace, contract.WALL_ALARM)
    needed_imports = imports.imported(source_of(workspace, contract.WALL_ALARM), without=("test",))
    expect_declared(needed_imports, manifest.needs("exec"), MISSING_AT_FIRST)
    expect_rosdep_key(manifest.needs(), "numpy")


@check(points=1, covers="alarm-licence", needs=("alarm_builds",), doc=contract.REP_149)
@hint("Two files name the licence. Do they agree?", "license='Apache-2.0' in setup.py.")
def test_alarm_licence(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """Both files name the licence Apache-2.0."""
    licences = read_manifest(workspace, contract.WALL_ALARM).licences
    licence = packaging.licence(installed_alarm)
    expect(
        licences == (contract.LICENCE,) and licence == contract.LICENCE,
        f"The licence is {', '.join(licences)} in package.xml and {licence or 'missing'} in setup.py; it should be "
        f"{contract.LICENCE} in both.",
    )
    others = [name for name in installed_alarm.classifiers if name.startswith("License ::")]
    others = [name for name in others if name not in contract.CLASSIFIERS]
    message = f"setup.py names the licence {licence}, and classifies the package under {', '.join(others)}."
    expect(not others, message, fraction=0.5)


@check(points=1, covers="alarm-pytest", needs=("alarm_builds",), doc=contract.COLCON)
@hint("colcon test runs pytest only for a package that says that it uses it.")
@hint("extras_require={'test': ['pytest']} says so to every setuptools.")
def test_alarm_names_pytest(workspace: Workspace, installed_alarm: installed.Installed) -> None:
    """setup.py says, in a way that colcon understands, that its tests are run by pytest."""
    packaging.expect_pytest(workspace, installed_alarm)


@check(
    points=2,
    covers=("alarm-runs", "alarm-given"),
    needs=("alarm_executable",),
    after=("alarm_subpackages",),
    doc=contract.CREATE,
)
@hint("ros2 run wall_alarm alarm in a new shell, after source install/setup.bash: what does it print?")
@hint("The node was right from the start: take it as it was given.")
def test_alarm_sounds(workspace: Workspace, draw: random.Random) -> None:
    """Its alarm goes off for a thing that is near, and not for one that is far."""
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
@hint("The configuration was right from the start: install it as it was given.", "distance: 0.8 is in metres.")
def test_alarm_configured(workspace: Workspace, installed_alarm: installed.Installed, draw: random.Random) -> None:
    """With the installed configuration it goes off from 0.8 m on."""
    path = installed_alarm.prefix / "share" / installed_alarm.package / contract.ALARM_CONFIG
    with robots.alarm(workspace, "--params-file", str(path)) as harness:
        robots.expect_alarm(harness, round(draw.uniform(0.66, 0.76), 2), True)
        robots.expect_alarm(harness, round(draw.uniform(0.84, 0.98), 2), False)


@check(points=1, covers="alarm-given", needs=("alarm_builds",), doc=contract.COLCON)
@hint(*HINTS)
def test_alarm_given_tests(workspace: Workspace) -> None:
    """The tests given with wall_alarm, the linters' too, notice a fault that is put into a copy of the package."""
    expect_given_tests(workspace, ALARM)
