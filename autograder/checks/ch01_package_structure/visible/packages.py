"""What colcon, rosdep and ros2 run would find of the two packages, at once."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checks import Visibility, check
from autograder.checks.ch01_package_structure.support import contract, judge, robots
from autograder.diagnosis import Diagnosis
from autograder.harness import Workspace
from autograder.probes import imports
from autograder.probes.installed import Installed

GROUP = "packages"
SEEN = Visibility.VISIBLE


@check(
    points=1,
    group=GROUP,
    visibility=SEEN,
    hints=(
        "Name, version, description, maintainer, licence and <export><build_type>: look at what ros2 pkg create wrote.",
        'The tags stand between <package format="3"> and </package>; <export> stands last.',
    ),
    doc=contract.CREATE,
)
def test_manifest(workspace: Workspace) -> None:
    """ROS takes square_dance/package.xml for that of a Python package."""
    judge.expect_manifest(workspace, contract.DANCE)


@check(
    points=1,
    group=GROUP,
    visibility=SEEN,
    depends=("manifest",),
    hints=(
        "Read the import lines of each file in square_dance: all that is neither Python's own nor the package's.",
        "<depend> for what the node imports, <exec_depend> for the launch file, <test_depend> for test/.",
    ),
    doc=contract.ROSDEP,
)
def test_dependencies(workspace: Workspace) -> None:
    """package.xml of square_dance declares whatever its files import."""
    manifest = judge.expect_manifest(workspace, contract.DANCE)
    judge.expect_declared(imports.imported(judge.folder(workspace, contract.DANCE)), manifest.needs())


@check(
    points=1,
    group=GROUP,
    visibility=SEEN,
    hints=(
        "Run colcon build in ws and read the first line that says error.",
        "can't copy 'resource/square_dance' means: the empty marker file is not there.",
    ),
    doc=contract.COLCON,
)
def test_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds square_dance."""
    judge.expect_built(builds, contract.DANCE)


@check(
    points=1,
    group=GROUP,
    visibility=SEEN,
    depends=("builds",),
    hints=(
        "Was a module left behind, or the program not found? packages= in setup.py says which, or the entry points.",
        "find_packages finds folders that have an __init__.py; setup.cfg says where programs go.",
    ),
    doc=contract.DEVELOP,
)
def test_dancer(workspace: Workspace, dance: Installed) -> None:
    """`ros2 run square_dance dancer` would find the program, with all of its modules, and it dances."""
    judge.expect_executable(dance, contract.DANCER)
    judge.expect_modules(dance, judge.folder(workspace, contract.DANCE))
    with robots.dancer(workspace) as harness:
        robots.expect_dance(harness, 1.0)


@check(
    points=1,
    group=GROUP,
    visibility=SEEN,
    depends=("builds",),
    hints=(
        "Each entry of data_files is a pair: a folder below the install prefix, and a list of files.",
        "('share/' + package_name + '/launch', glob('launch/*.launch.py')); config goes the same way.",
    ),
    doc=contract.DEVELOP,
)
def test_shared(workspace: Workspace, dance: Installed) -> None:
    """The launch file and the configuration of square_dance are installed."""
    for name in (contract.DANCE_LAUNCH, contract.DANCE_CONFIG):
        judge.expect_shared(dance, judge.folder(workspace, contract.DANCE), name)


@check(
    points=1,
    group=GROUP,
    visibility=SEEN,
    hints=(
        "Run colcon build --paths src/wall_alarm in ws and read the first line that says error.",
        "The marker is an empty file: resource/wall_alarm.",
    ),
    doc=contract.COLCON,
)
def test_alarm_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds wall_alarm."""
    judge.expect_built(builds, contract.WATCH)


@check(
    points=1,
    group=GROUP,
    visibility=SEEN,
    depends=("alarm_builds",),
    hints=(
        "Mend it rung by rung: what does ros2 run wall_alarm alarm say now?",
        "No executable found: setup.cfg. No module named ...: packages= in setup.py.",
    ),
    doc=contract.DEVELOP,
)
def test_alarm_runs(workspace: Workspace, watch: Installed) -> None:
    """`ros2 run wall_alarm alarm` would find the program, and its alarm goes off."""
    judge.expect_executable(watch, contract.ALARM)
    judge.expect_modules(watch, judge.folder(workspace, contract.WATCH))
    with robots.alarm(workspace) as harness:
        robots.expect_alarm(harness, 0.3, True)
        robots.expect_alarm(harness, 3.0, False)


@check(
    points=1,
    group=GROUP,
    visibility=SEEN,
    hints=(
        "numpy's name in package.xml is python3-numpy: rosdep's key, not pip's.",
        "The launch file imports three packages; each is an <exec_depend>.",
    ),
    doc=contract.ROSDEP,
)
def test_alarm_dependencies(workspace: Workspace) -> None:
    """package.xml of wall_alarm declares whatever its files import."""
    manifest = judge.expect_manifest(workspace, contract.WATCH)
    judge.expect_declared(imports.imported(judge.folder(workspace, contract.WATCH)), manifest.needs())
