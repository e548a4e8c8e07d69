"""Step 1: the declarations in package.xml, and the files that setup.py installs."""

from __future__ import annotations

import random
from collections.abc import Mapping

from autograder.checking import OK, Diagnosis, Workspace, expect, group, hint
from autograder.checking.probes import added_files, imports, installed, manifest, packaging
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import INTERFACES, LICENCE, PACKAGE, PROGRAMS, VERSION
from autograder.checks.ch08_capstone.support.sources import require_built, source_of

check = group("step_1", doc=contract.PACKAGES_DOC)
# Dependencies of the launch file, and of the tests.
FOR_LAUNCH = ("ament_index_python", "launch", "launch_ros")
FOR_TESTS = ("ament_flake8", "ament_pep257", "launch_pytest")


@check(points=2, covers=("manifest", "interfaces-facts"))
@hint("The order of the tags is name, version, description, maintainer, license, then the dependencies, then export.")
@hint("<export><build_type>ament_python</build_type></export>; ament_cmake for the messages.")
def test_manifests(workspace: Workspace) -> None:
    """Both packages have a package.xml that ROS accepts, with the licence, the version and the right build type."""
    for name, build_type in ((PACKAGE, "ament_python"), (INTERFACES, "ament_cmake")):
        package_xml = manifest.read(source_of(workspace, name))
        expect(package_xml.format == 3, f"{name}/package.xml has format {package_xml.format}, instead of 3.")
        expect(
            package_xml.version == VERSION,
            f"{name}/package.xml says version {package_xml.version}, instead of {VERSION}.",
        )
        licences = ", ".join(package_xml.licences)
        expect(
            package_xml.licences == (LICENCE,),
            f"{name}/package.xml says licence {licences!r}: the SPDX identifier is {LICENCE}.",
        )
        expect(
            package_xml.build_type == build_type,
            f"{name}/package.xml exports the build type {package_xml.build_type or 'nothing'!r}, "
            f"instead of {build_type}.",
        )


@check(points=2, covers=("imports", "depend", "exec-depend", "test-depend"), after=("manifests",))
@hint(
    "rosdep installs what package.xml names, before anything runs: what is missing there is missing on every other "
    "machine."
)
@hint("The launch file needs three packages, too; the linters and launch_pytest are test_depends.")
def test_dependencies(workspace: Workspace) -> None:
    """The manifest of the nodes declares every package that their code, launch file and tests use."""
    source = source_of(workspace, PACKAGE)
    package_xml = manifest.read(source)
    missing = imports.missing(source, package_xml)
    expect(
        not missing["exec"], f"{imports.describe(missing['exec'])}: package.xml does not declare it as a dependency."
    )
    expect(
        not missing["test"],
        f"{imports.describe(missing['test'])}: package.xml has no test_depend for it.",
        fraction=0.5,
    )
    for kind, names in (("exec", FOR_LAUNCH), ("test", FOR_TESTS)):
        absent = [name for name in names if name not in package_xml.needs("exec", kind)]
        expect(not absent, f"package.xml has no {kind}_depend on {', '.join(absent)}.", fraction=0.5)


@check(points=1, covers="installs")
@hint("Run colcon build --packages-up-to robot_navigation_tutorial in a terminal: its last lines name file and line.")
@hint("setup.py needs the name, packages=find_packages(exclude=['test']), data_files with files that are there.")
def test_build(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds the package of the nodes."""
    require_built(builds, PACKAGE)


@check(points=1, covers=("processor-executable", "controller-executable", "monitor-executable"), needs=("build",))
@hint("entry_points={'console_scripts': ['sensor_processor = robot_navigation_tutorial.sensor_processor:main', ...]}")
@hint("install_scripts in setup.cfg says where they go; packages=find_packages(exclude=['test']) what they import.")
def test_executables(workspace: Workspace) -> None:
    """The build installs the package's three executables where ros2 run looks."""
    installation = installed.inspect_package(workspace.install, PACKAGE)
    absent = [name for name in PROGRAMS if name not in installation.executables]
    executables = ", ".join(installation.executables) or "none"
    misplaced_text = (
        f" bin/, where ros2 run does not look, has {', '.join(installation.misplaced)}."
        if installation.misplaced
        else ""
    )
    expect(
        not absent,
        f"The executable {', '.join(absent)} is not installed; installed are: {executables}.{misplaced_text}",
        fraction=round(0.9 * (1.0 - len(absent) / len(PROGRAMS)), 2),
    )


@check(points=1, covers="installs", needs=("build",))
@hint("data_files holds pairs: a folder below share/, and the files that go there.")
@hint("('share/' + package_name + '/launch', glob('launch/*.launch.py')), and config likewise.")
def test_shares(workspace: Workspace) -> None:
    """setup.py installs the manifest, the launch file and the configuration."""
    installation = installed.inspect_package(workspace.install, PACKAGE)
    expected = ("package.xml", f"launch/{contract.LAUNCH_FILE}", contract.CONFIG)
    absent = [path for path in expected if path not in installation.shared]
    expect(not absent, f"share/{PACKAGE} has no {', '.join(absent)}: look at data_files.")


@check(points=1, covers="installs", needs=("build",), after=("shares",))
@hint("A list of names written by hand is wrong on the day when somebody adds a file.")
@hint("glob('launch/*.launch.py') and glob('config/*.yaml') look at what is there when the package is built.")
def test_grows(workspace: Workspace, draw: random.Random) -> None:
    """A new launch file and a new configuration are installed without a change of setup.py."""
    name = f"maze_{draw.randrange(100, 1000)}"
    added_paths = (f"launch/{name}.launch.py", f"config/{name}.yaml")
    shared = added_files.install_with(workspace, PACKAGE, added_paths).shared
    absent = [path for path in added_paths if path not in shared]
    expect(not absent, f"The new {' and '.join(absent)} stayed behind: look at data_files.", fraction=0.5)


@check(
    points=1,
    covers=(
        "agree",
        "installs",
        "interfaces-cmake",
        "manifest",
        "processor-executable",
        "controller-executable",
        "monitor-executable",
    ),
    needs=("build",),
    after=("manifests",),
)
@hint("Copy the four from one file to the other, to the letter.")
@hint("data_files as ros2 pkg create writes it installs the marker and package.xml; ament_package() does it in CMake.")
def test_agreement(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """package.xml and setup.py agree on version, licence and maintainer; ROS finds both packages by their markers."""
    package_xml = manifest.read(source_of(workspace, PACKAGE))
    installation = installed.inspect_package(workspace.install, PACKAGE)
    metadata = installation.metadata
    maintainer, address = next(iter(package_xml.maintainers), ("nobody", "nothing"))
    for header, expected in (
        ("Version", package_xml.version),
        ("License", ", ".join(package_xml.licences)),
        ("Maintainer", maintainer),
        ("Maintainer-email", address),
    ):
        actual = metadata.get(header, "nothing")
        expect(actual == expected, f"{header.lower()}: package.xml says {expected!r}, setup.py says {actual!r}.")
    packaging.expect_installs_itself(installation)
    if builds[INTERFACES] is OK:
        message = f"The ament index does not know {INTERFACES}: CMakeLists.txt does not call ament_package()."
        expect(installed.inspect_package(workspace.install, INTERFACES).marker, message, fraction=0.5)
    description = package_xml.description
    expect(
        manifest.PLACEHOLDER not in description, f"package.xml describes the package as {description!r}.", fraction=0.5
    )
    modules = [f"{PACKAGE}.{name}" for name in PROGRAMS]
    absent = [module for module in modules if module not in installation.modules]
    expect(not absent, f"There is no module {', '.join(absent)}, which the table of step 1 names.", fraction=0.5)
