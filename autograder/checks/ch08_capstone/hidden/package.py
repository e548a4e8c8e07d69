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
    """Both packages have a valid package.xml, with the licence, version and build type of the contract."""
    for name, build_type in ((PACKAGE, "ament_python"), (INTERFACES, "ament_cmake")):
        package_xml = manifest.read(source_of(workspace, name))
        expect(package_xml.format == 3, f"{name}/package.xml has the format {package_xml.format}, instead of 3.")
        expect(
            package_xml.version == VERSION,
            f"{name}/package.xml has the version {package_xml.version}, instead of {VERSION}.",
        )
        licences = ", ".join(package_xml.licences)
        expect(
            package_xml.licences == (LICENCE,),
            f"{name}/package.xml has the licence {licences!r}, instead of the SPDX identifier {LICENCE}.",
        )
        expect(
            package_xml.build_type == build_type,
            f"{name}/package.xml exports the build type {package_xml.build_type or 'none'!r}, instead of {build_type}.",
        )


@check(points=2, covers=("imports", "depend", "exec-depend", "test-depend"), after=("manifests",))
@hint(
    "rosdep installs only the packages that package.xml declares. A package that it does not declare is missing on "
    "other machines."
)
@hint("The launch file needs three packages, too. Declare the linters and launch_pytest as test_depend.")
def test_dependencies(workspace: Workspace) -> None:
    """The manifest of the nodes' package declares every package that its code, launch file and tests use."""
    source = source_of(workspace, PACKAGE)
    package_xml = manifest.read(source)
    missing = imports.missing(source, package_xml)
    expect(not missing["exec"], f"{imports.describe(missing['exec'])}: not declared as a dependency in package.xml.")
    expect(
        not missing["test"],
        f"{imports.describe(missing['test'])}: not declared as test_depend in package.xml.",
        fraction=0.5,
    )
    for kind, names in (("exec", FOR_LAUNCH), ("test", FOR_TESTS)):
        missing_names = [name for name in names if name not in package_xml.needs("exec", kind)]
        expect(not missing_names, f"package.xml has no {kind}_depend on {', '.join(missing_names)}.", fraction=0.5)


@check(points=1, covers="installs")
@hint("Run colcon build --packages-up-to robot_navigation_tutorial: its last lines name the file and the line.")
@hint("setup.py needs name, packages=find_packages(exclude=['test']), and data_files with files that exist.")
def test_build(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds the package with the nodes."""
    require_built(builds, PACKAGE)


@check(points=1, covers=("processor-executable", "controller-executable", "monitor-executable"), needs=("build",))
@hint("entry_points={'console_scripts': ['sensor_processor = robot_navigation_tutorial.sensor_processor:main', ...]}")
@hint(
    "install_scripts in setup.cfg sets the folder of the executables. packages=find_packages(exclude=['test']) "
    "installs the modules that they import."
)
def test_executables(workspace: Workspace) -> None:
    """The build installs the package's three executables where ros2 run looks for them."""
    installation = installed.inspect_package(workspace.install, PACKAGE)
    missing_programs = [name for name in PROGRAMS if name not in installation.executables]
    executables = ", ".join(installation.executables) or "none"
    misplaced_text = (
        f" bin/, where ros2 run does not look, contains {', '.join(installation.misplaced)}."
        if installation.misplaced
        else ""
    )
    expect(
        not missing_programs,
        f"The build did not install the executable {' or '.join(missing_programs)}. "
        f"Installed executables: {executables}.{misplaced_text}",
        fraction=round(0.9 * (1.0 - len(missing_programs) / len(PROGRAMS)), 2),
    )


@check(points=1, covers="installs", needs=("build",))
@hint("data_files is a list of pairs: a folder below share/, and the files to install there.")
@hint("('share/' + package_name + '/launch', glob('launch/*.launch.py')), and the same for config.")
def test_shares(workspace: Workspace) -> None:
    """setup.py installs the manifest, the launch file and the configuration file."""
    installation = installed.inspect_package(workspace.install, PACKAGE)
    expected = ("package.xml", f"launch/{contract.LAUNCH_FILE}", contract.CONFIG)
    missing_paths = [path for path in expected if path not in installation.shared]
    expect(not missing_paths, f"share/{PACKAGE} has no {' and no '.join(missing_paths)}: check data_files.")


@check(points=1, covers="installs", needs=("build",), after=("shares",))
@hint("A hand-written list of files is out of date as soon as a file is added.")
@hint("glob('launch/*.launch.py') and glob('config/*.yaml') find the files that exist when the package is built.")
def test_grows(workspace: Workspace, draw: random.Random) -> None:
    """A launch file and a configuration file that are added later are installed without a change to setup.py."""
    name = f"maze_{draw.randrange(100, 1000)}"
    added_paths = (f"launch/{name}.launch.py", f"config/{name}.yaml")
    shared_files = added_files.install_with(workspace, PACKAGE, added_paths).shared
    missing_paths = [path for path in added_paths if path not in shared_files]
    expect(
        not missing_paths,
        f"The build did not install the new {' and '.join(missing_paths)}: check data_files.",
        fraction=0.5,
    )


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
@hint("Copy version, licence, maintainer and e-mail address from one file to the other, without any change.")
@hint(
    "The data_files that ros2 pkg create writes install the marker and package.xml. In CMake, ament_package() installs "
    "them."
)
def test_agreement(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """package.xml and setup.py agree on name, version, licence and maintainer. ROS finds both packages."""
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
        expect(actual == expected, f"{header.lower()}: package.xml says {expected!r}, but setup.py says {actual!r}.")
    name = installation.setup_name or "nothing"
    expect(name == PACKAGE, f"name: package.xml says {PACKAGE!r}, but setup.py says {name!r}.")
    packaging.expect_installs_itself(installation)
    if builds[INTERFACES] is OK:
        message = f"The ament index does not know {INTERFACES}: CMakeLists.txt does not call ament_package()."
        expect(installed.inspect_package(workspace.install, INTERFACES).marker, message, fraction=0.5)
    description = package_xml.description
    expect(
        manifest.PLACEHOLDER not in description,
        f"The description in package.xml is still the placeholder {description!r}.",
        fraction=0.5,
    )
    modules = [f"{PACKAGE}.{name}" for name in PROGRAMS]
    missing_modules = [module for module in modules if module not in installation.modules]
    expect(
        not missing_modules,
        f"The build did not install {' and '.join(missing_modules)}, as required by the table of step 1.",
        fraction=0.5,
    )
