"""The page `platform.md`: the versions of ROS's platform, and the installed ones."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from packaging.requirements import Requirement

from autograder.author.course.markdown_table import table
from autograder.course_paths import ROOT
from autograder.ros.distribution import DISTRIBUTION as ROS
from autograder.ros.distribution import PlatformPackage
from autograder.ros.launch_packages import SOURCES, Source
from autograder.ros.ros2.exceptions import NotCoveredError
from autograder.ros.ros2.main import COMMANDS

LOCK = ROOT / "requirements.lock"
DIFFERENCES = ROOT / "tests" / "e2e" / "launch_standin" / "differences.yaml"
SUBMODULES = ROOT / "autograder" / "ros" / "standins" / "standin_submodules.py"
TUTORIALS = ROOT / "tests" / "e2e" / "tutorials" / "pages.yaml"
PYTHONS = sorted(ROS.pythons)
REQUIREMENT = re.compile(r"^([^\s#-][^\\\n]*)", re.MULTILINE)

HEAD = f"""# The platform and the installed versions

The platform of ROS 2 {ROS.title} is {ROS.platform} with Python {ROS.pythons[0]}. Students' programs, builds and tests
use the versions of that platform, so that everything a student learns here is valid there. `make setup` installs them
from `requirements.lock`. `autograder doctor` reports different versions on a machine. The versions of Ubuntu are listed
on {ROS.platform_page}. The version of catkin_pkg comes from ROS's own package repository.

`make docs` writes this page from the lock.
"""
COLUMNS = ("package", "apt's name", ROS.platform, "here", "where students use it", "reason for another version")
TAIL = """## Interface packages without wheels

The ROS tutorials use `example_interfaces`, `action_tutorials_interfaces` and `tf2_msgs`. Set-up builds them for Python
programs from `autograder/building/interfaces/tutorials.yaml`, which takes about ten seconds. Their types have the
hashes of the real ones, so programs can communicate with other computers. CMake packages cannot use them, because they
have no CMake files.

A CMake package from `ros2 pkg create` requires `ament_lint_auto`, which has no wheel. Set-up installs an empty
replacement. The package can be built, but has no linters.

## Public packages

`make public-packages` builds the Python packages of ros2/examples, and `demo_nodes_py` and `action_tutorials_py` of
ros2/demos, without changes. It runs their tests with `colcon test`, and lets their servers and clients, publishers and
subscribers communicate.
"""
TUTORIAL_HEAD = f"""## The ROS tutorials

`make tutorials` executes the Python tutorials in {ROS.title}'s documentation, in "Beginner: Client libraries" and
"Intermediate: Launch". It takes commands, code and file changes from the pages. `tests/e2e/tutorials/pages.yaml` says
what each command prints. `make tutorials PYTEST_ARGS="-k NAME"` executes one of them. turtlesim and `demo_nodes_cpp`
are written in C++ and have no wheels. The tests use Python packages with the same names, topics, services and
parameters.
"""
TUTORIAL_COLUMNS = ("tutorial", "runs as printed", "NAME of its test", "omitted parts, or why it does not run")
REAL_LAUNCH = """
## `launch`, `launch_ros` and `ros2cli`

They are not on the package index. Set-up clones their repositories from GitHub, builds them with pip and installs them:

| repository | tag | commit | packages |
| --- | --- | --- | --- |
{sources}

A clone at another commit is rejected. The id of a commit is a digest of all its files, like the hash of an archive.
GitHub does not guarantee that the archive of a tag always has the same bytes. `osrf-pycommon`, which `launch`
imports, comes from the package index and is pinned by its hash.

If a repository does not respond within ten seconds, or a step fails, set-up installs none of the packages, says so in
one line, and the course's stand-ins are used. `ROS2_STANDINS=1 make setup` chooses the stand-ins directly. Keep the
variable set, because the next set-up without it tries again. `make real-launch` also tries again, and fails if it
cannot install the packages. A variable sets another source, such as `ROS2_LAUNCH_SOURCE=/clones/launch`, and
`/clones/launch@TAG` uses another tag. A student release works in the same way. `autograder doctor` and the field
`launch` of each result say what is installed.
"""
STAND_INS = """## Limits of the stand-ins

They are used only if the real packages are not importable. Tests compare them with recordings of the real packages:
launch files in Python, XML and YAML, launch tests, and the commands of `ros2`. Differences are listed, with reasons, in
`tests/e2e/launch_cases/differences.yaml` and `tests/e2e/ros2_records/differences.yaml`. Features that are not covered
raise an error that says so. After `make real-launch`, or with a sourced ROS 2, the real packages are used instead.
"""
DIFFERENT = """
`tests/e2e/launch_standin` tests the stand-ins in more detail. If the real packages are installed, it tests those. They
fail the following tests, in which the stand-in leaves no process behind, does not hang, or gives a clearer error:
"""
DIFFERENT_COLUMNS = ("test", "behaviour of the real package")
UNCOVERED = ("not covered", "reason", "error message")
COMPOSABLE = "they are C++ components, and `composition_interfaces` has no wheel"
INTERNAL = "neither the course nor a Python tutorial of ROS uses it"
INTERNAL_MODULE = "it is internal to the real package"
FOR_CPP = "it is for C++"
FOR_ONE_PROCESS = "it is for tests of one process without a launch description"
LAUNCH = {
    "launch_ros.actions.ComposableNodeContainer": COMPOSABLE,
    "launch_ros.actions.LoadComposableNodes": COMPOSABLE,
    "launch_ros.descriptions.ComposableNode": COMPOSABLE,
    "launch_testing.actions.GTest": FOR_CPP,
    "launch_testing.tools.launch_process": FOR_ONE_PROCESS,
}
INTERNAL_NAMES = {
    "launch": "SomeEntitiesType_types_tuple",
    "launch.event_handlers": "event_named gen_handler",
    "launch.frontend.entity": "TargetType",
    "launch.frontend.parse_substitution": "ExtractSubstitution get_grammar_path",
    "launch.launch_introspector": (
        "format_action format_entities format_event_handler format_substitutions indent tree_like_indent"
    ),
    "launch.logging": "LaunchLogger",
    "launch.utilities": (
        "AsyncSafeSignalManager FilePath isclassinstance normalize_to_list_of_entities "
        "visit_all_entities_and_collect_futures"
    ),
    "launch.utilities.type_utils": (
        "coerce_list extract_type is_instance_of_valid_type is_normalized_substitution is_typing_list "
        "is_valid_scalar_type"
    ),
    "launch_pytest.tools.process": "register_event_handler",
    "launch_ros.actions": "LifecycleNode LifecycleTransition ROSTimer RosTimer get_composable_node_load_request",
    "launch_ros.actions.node": "NodeActionExtension get_extensions instantiate_extension",
    "launch_ros.utilities": (
        "OptionalText PluginException add_node_name evaluate_parameter_dict get_node_name_count "
        "get_upper_bound_caret_version is_root_namespace normalize_parameter_dict normalize_parameters "
        "normalize_remap_rule normalize_remap_rules satisfies_version to_parameters_list"
    ),
    "launch_testing.actions": "PyTest",
    "launch_testing.loader": (
        "LoadTestsFromPythonModule PostShutdownTestLoader PreShutdownTestLoader slim_formatwarning"
    ),
    "launch_testing.test_result": "FailResult SkipResult",
    "launch_testing.test_runner": "LaunchTestRunner",
    "launch_testing.tools": "ProcessProxy basic_output_filter expect_output expected_output_from_file",
    "rosidl_runtime_py.utilities": (
        "get_action_namespaced_type get_namespaced_type get_service_namespaced_type is_action is_message is_service"
    ),
    "ament_copyright": "get_copyright_names get_licenses",
    "ament_copyright.main": (
        "add_copyright_year add_header add_missing_header get_comment get_string_from_years get_xunit_content "
        "get_years_from_string"
    ),
}


def platform_page(lock: str, tutorials: str) -> str:
    """Return the page as Markdown.

    Args:
        lock: the text of `requirements.lock`.
        tutorials: the text of `pages.yaml`, from which the tutorials are tested.
    """
    versions_by_python = {python: locked(lock, python) for python in PYTHONS}
    versions = table(COLUMNS, (_row(package, versions_by_python) for package in ROS.packages))
    pages = table(TUTORIAL_COLUMNS, map(_tutorial, yaml.safe_load(tutorials)))
    stand_ins = [STAND_INS, *table(UNCOVERED, _uncovered_rows()), DIFFERENT, *table(DIFFERENT_COLUMNS, _differences())]
    real_launch = REAL_LAUNCH.format(sources="\n".join(map(_source, SOURCES)))
    return "\n".join([HEAD, *versions, TAIL, TUTORIAL_HEAD, *pages, real_launch, *stand_ins])


def _source(source: Source) -> str:
    name = Path(source.url).stem
    packages = ", ".join(f"`{name if package == '.' else package}`" for package in source.packages)
    return f"| [{name}]({source.url.removesuffix('.git')}) | {source.tag} | `{source.commit}` | {packages} |"


def current() -> str:
    """Return the page for the current state of the repository."""
    return platform_page(LOCK.read_text(encoding="utf-8"), TUTORIALS.read_text(encoding="utf-8"))


def locked(lock: str, python: str) -> dict[str, str]:
    """Return the version of each package that a lock installs for a Python of this version, on Linux x86-64.

    Raises:
        InvalidRequirement: a line is not a requirement.
    """
    return {requirement.name: next(iter(requirement.specifier)).version for requirement in _requirements(lock, python)}


def _requirements(lock: str, python: str) -> Iterator[Requirement]:
    machine = {"platform_machine": "x86_64", "sys_platform": "linux"}
    environment = {**machine, "python_version": python, "python_full_version": f"{python}.0"}
    for line in REQUIREMENT.findall(lock):
        requirement = Requirement(line)
        if requirement.marker is None or requirement.marker.evaluate(environment):
            yield requirement


def _tutorial(page: dict[str, Any]) -> tuple[str, str, str, str]:
    link = f"[{page['title']}]({ROS.docs}/Tutorials/{page['page']}.html)"
    if "missing" in page:
        return link, "no", "", page["missing"]
    return link, "yes", f"`{page['name']}`", page.get("but", "")


def _uncovered_rows() -> Iterator[tuple[str, str, str]]:
    def error(name: str) -> str:
        return f"'{name}' is not covered: this is the course's stand-in …"

    for name, reason in LAUNCH.items():
        yield f"`{name}`", reason, error(name)
    yield (
        "`launch_testing_ros`",
        "it is a separate package, and the course does not use it",
        error("launch_testing_ros"),
    )
    # The stand-ins are only importable if the real packages are not, so their source is parsed.
    match = re.search(r"^NOT_COVERED = (\{.*?^\})", SUBMODULES.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    assert match
    for reason, parts in ((INTERNAL_MODULE, ast.literal_eval(match[1])), (INTERNAL, INTERNAL_NAMES)):
        for parent, names in parts.items():
            full_names = [f"{parent}.{name}" for name in names.split()]
            yield ", ".join(f"`{name}`" for name in full_names), reason, error(full_names[0])
    for option in ("--node-name", "--library-name"):
        command = f"`ros2 pkg create --build-type ament_cmake {option}`"
        yield command, FOR_CPP, f"{command}, a C++ package, is not covered by this stand-in …"
    for word, group in COMMANDS.items():
        missing_commands = [f"ros2 {word} {verb}" for verb in group.not_covered] if group.module else [f"ros2 {word}"]
        for command in missing_commands:
            message = str(NotCoveredError(f"`{command}`")).partition(";")[0]
            yield f"`{command}`", "the course does not use it", f"{message} …"


def _differences() -> Iterator[tuple[str, str]]:
    for test, reason in yaml.safe_load(DIFFERENCES.read_text(encoding="utf-8")).items():
        yield f"`{test.partition('[')[0]}`", reason


def _row(package: PlatformPackage, versions_by_python: dict[str, dict[str, str]]) -> tuple[str, ...]:
    by_version: dict[str, list[str]] = {}
    for python, versions in versions_by_python.items():
        by_version.setdefault(versions[package.name], []).append(python)
    installed_versions = "; ".join(
        version if len(pythons) == len(PYTHONS) else f"{version} (Python {_span(pythons)})"
        for version, pythons in by_version.items()
    )
    return package.name, package.debian, package.version, installed_versions, package.meets, package.differs


def _span(pythons: list[str]) -> str:
    return pythons[0] if len(pythons) == 1 else f"{pythons[0]} to {pythons[-1]}"
