"""The page `platform.md`: the versions of ROS's platform, and what is installed here."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from packaging.requirements import Requirement

from autograder.author.course.markdown_table import table
from autograder.layout import ROOT
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

HEAD = f"""# The platform, and what is installed here

ROS 2 {ROS.title} belongs to {ROS.platform} with Python {ROS.pythons[0]}. What students' programs, builds and tests meet
has the versions of that platform, so that what a student learns here holds there. `make setup` installs them from
`requirements.lock`. `autograder doctor` says where a machine has others. The versions of Ubuntu are those of
{ROS.platform_page}; that of catkin_pkg is the one in ROS's own package repository.

`make docs` writes this page from the lock.
"""
COLUMNS = ("package", "apt's name", ROS.platform, "here", "where a student meets it", "why another version")
TAIL = """## Interface packages without wheels

The tutorials of ROS use `example_interfaces`, `action_tutorials_interfaces` and `tf2_msgs`. Set-up builds them for
Python programs, from `autograder/building/interfaces/tutorials.yaml`; it takes about ten seconds. Their types have
the hashes of the real ones, so programs meet those of other computers. A CMake package cannot use them: they have no
CMake files.

A CMake package that `ros2 pkg create` has written asks for `ament_lint_auto`, which has no wheel. Set-up puts an empty
one in its place. The package is built, and has no linters.

## Public packages

`make public-packages` builds the Python packages of ros2/examples, and `demo_nodes_py` and `action_tutorials_py` of
ros2/demos, as they are. It runs their tests by `colcon test`, and lets their servers and clients, publishers and
subscribers meet.
"""
TUTORIAL_HEAD = f"""## The tutorials of ROS

`make tutorials` does what the Python tutorials of {ROS.title}'s documentation say, in "Beginner: Client libraries"
and "Intermediate: Launch". It takes commands, code and changes of files from the pages, and expects to see what they
say one sees. `make tutorials PYTEST_ARGS="-k NAME"` does one of them. turtlesim and `demo_nodes_cpp` are written in C++
and have no wheels. The tests use packages in Python that have the same names, topics, services and parameters.
"""
TUTORIAL_COLUMNS = ("tutorial", "runs as printed", "NAME of its test", "what is left out, or why it does not run")
REAL_LAUNCH = """
## `launch`, `launch_ros` and `ros2cli`

They are not on the package index. Set-up clones their repositories from GitHub, builds them with pip and installs them:

| repository | tag | commit | packages |
| --- | --- | --- | --- |
{sources}

A clone that is at another commit is refused. The id of a commit is a digest of all its files, so it does what a hash
does for an archive; the archives that GitHub makes of a tag are not promised to keep their bytes. `osrf-pycommon`,
which `launch` imports, comes from the package index and is pinned by its hash.

Where a repository does not answer within ten seconds, or a step fails, set-up installs none of them, says so in one
line, and the course's stand-ins are used. `ROS2_STANDINS=1 make setup` uses the stand-ins at once; keep the variable
set, since the next set-up without it tries again. So does `make real-launch`, which fails if it cannot install them. A
variable names another place to clone from, such as `ROS2_LAUNCH_SOURCE=/clones/launch`, and `/clones/launch@TAG` takes
another tag as it is. A student release does the same. `autograder doctor` and the field `launch` of each result say
what is installed.
"""
STAND_INS = """## What the stand-ins do not cover

They are used only where the real packages are not importable. Tests hold them to records of the real packages: launch
files in Python, XML and YAML, launch tests, and the commands of `ros2`. Where a stand-in does something else,
`tests/e2e/launch_cases/differences.yaml` and `tests/e2e/ros2_records/differences.yaml` have it, each with its reason.
What is not covered raises an error that says so. After `make real-launch`, or with a sourced ROS 2, the real packages
run instead.
"""
OTHERWISE = """
`tests/e2e/launch_standin` tests the stand-ins more closely. With the real packages installed, it tests those. They do
not pass these tests, in which the stand-in leaves no process, does not hang, or gives a clearer error:
"""
OTHERWISE_COLUMNS = ("test", "what the real one does")
UNCOVERED = ("not covered", "why", "the error")
COMPOSABLE = "they are C++ components, and `composition_interfaces` has no wheel"
INNER = "neither the course nor a Python tutorial of ROS uses it"
INNER_MODULE = "it is inside the real package"
OF_CPP = "it is for C++"
SINGLE = "it is for tests of one process without a launch description"
LAUNCH = {
    "launch_ros.actions.ComposableNodeContainer": COMPOSABLE,
    "launch_ros.actions.LoadComposableNodes": COMPOSABLE,
    "launch_ros.descriptions.ComposableNode": COMPOSABLE,
    "launch_testing.actions.GTest": OF_CPP,
    "launch_testing.tools.launch_process": SINGLE,
}
INNER_NAMES = {
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
    by_python = {python: locked(lock, python) for python in PYTHONS}
    versions = table(COLUMNS, (_row(package, by_python) for package in ROS.packages))
    pages = table(TUTORIAL_COLUMNS, map(_tutorial, yaml.safe_load(tutorials)))
    stand_ins = [STAND_INS, *table(UNCOVERED, _uncovered()), OTHERWISE, *table(OTHERWISE_COLUMNS, _otherwise())]
    real_launch = REAL_LAUNCH.format(sources="\n".join(map(_source, SOURCES)))
    return "\n".join([HEAD, *versions, TAIL, TUTORIAL_HEAD, *pages, real_launch, *stand_ins])


def _source(source: Source) -> str:
    name = Path(source.url).stem
    packages = ", ".join(f"`{name if package == '.' else package}`" for package in source.packages)
    return f"| [{name}]({source.url.removesuffix('.git')}) | {source.tag} | `{source.commit}` | {packages} |"


def current() -> str:
    """Return the page for what the repository has now."""
    return platform_page(LOCK.read_text(encoding="utf-8"), TUTORIALS.read_text(encoding="utf-8"))


def locked(lock: str, python: str) -> dict[str, str]:
    """Return the version of each package that a lock installs for a Python of this version, on Linux x86-64.

    Raises:
        InvalidRequirement: a line is no requirement.
    """
    return {found.name: next(iter(found.specifier)).version for found in _requirements(lock, python)}


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


def _uncovered() -> Iterator[tuple[str, str, str]]:
    def error(name: str) -> str:
        return f"'{name}' is not covered: this is the course's stand-in …"

    for name, reason in LAUNCH.items():
        yield f"`{name}`", reason, error(name)
    yield (
        "`launch_testing_ros`",
        "it is a package of its own, and the course does not use it",
        error("launch_testing_ros"),
    )
    # The stand-ins are importable only where the real packages are not, so their text is read.
    found = re.search(r"^NOT_COVERED = (\{.*?^\})", SUBMODULES.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    assert found
    for reason, parts in ((INNER_MODULE, ast.literal_eval(found[1])), (INNER, INNER_NAMES)):
        for parent, names in parts.items():
            full = [f"{parent}.{name}" for name in names.split()]
            yield ", ".join(f"`{name}`" for name in full), reason, error(full[0])
    for option in ("--node-name", "--library-name"):
        called = f"`ros2 pkg create --build-type ament_cmake {option}`"
        yield called, OF_CPP, f"{called}, a C++ package, is not covered by this stand-in …"
    for word, command in COMMANDS.items():
        missing = [f"ros2 {word} {verb}" for verb in command.not_covered] if command.module else [f"ros2 {word}"]
        for called in missing:
            error = str(NotCoveredError(f"`{called}`")).partition(";")[0]
            yield f"`{called}`", "the course does not use it", f"{error} …"


def _otherwise() -> Iterator[tuple[str, str]]:
    for test, reason in yaml.safe_load(DIFFERENCES.read_text(encoding="utf-8")).items():
        yield f"`{test.partition('[')[0]}`", reason


def _row(package: PlatformPackage, by_python: dict[str, dict[str, str]]) -> tuple[str, ...]:
    here: dict[str, list[str]] = {}
    for python, versions in by_python.items():
        here.setdefault(versions[package.name], []).append(python)
    told = "; ".join(
        version if len(pythons) == len(PYTHONS) else f"{version} (Python {_span(pythons)})"
        for version, pythons in here.items()
    )
    return package.name, package.debian, package.version, told, package.meets, package.differs


def _span(pythons: list[str]) -> str:
    return pythons[0] if len(pythons) == 1 else f"{pythons[0]} to {pythons[-1]}"
