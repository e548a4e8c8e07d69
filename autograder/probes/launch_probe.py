"""Assertions about launch files: declared arguments, started nodes, and failures."""

from __future__ import annotations

import re
import shutil
import time
from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import replace
from itertools import pairwise
from types import MappingProxyType

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.harness.launch import LaunchHarness, Stop, sandbox, start
from autograder.probes.launch_arguments import Argument, parse_arguments
from autograder.probes.parameters import Value, same
from autograder.probes.rclpy_races import crashed, lost_a_race
from autograder.run.lockstep.tracebacks import with_source_paths
from autograder.run.workspace import Workspace
from autograder.submission.reading import reading
from autograder.suite import CheckFailed, expect

START_SECONDS = 40.0  # real time to wait for all nodes; long enough for a busy machine
QUIET_SECONDS = 1.5  # real time without a change after which `settle` expects no more nodes
STOP_SECONDS = 20.0  # real time to wait for the end of the launch; nodes that end cleanly need 0.2 s
SHOW_SECONDS = 30.0  # real time for `ros2 launch -s`
KILLED = "-9"  # the exit code of a process that neither SIGINT nor SIGTERM has ended

_EXCEPTION = re.compile(r"Caught exception in launch \(see debug for traceback\): (?P<reason>.+(?:\n - .+)?)")
_PATH = re.compile(r"/[^\s'\"]+")
_WORKSPACE = re.compile(r"/ws[^/]*(?=/(?:src|install)/)")  # a workspace's folder in a path
_NOT_READ = "Caught multiple exceptions when trying to load file"
_PLACE = re.compile(r'^  File "(?P<file>ws/src/[^"\n]+)", line (?P<line>\d+)', re.MULTILINE)
_LABEL = r"\[(?P<label>(?P<name>[^\[\]\n]+)-\d+)\]: "  # the name and the number of a program
_STARTED = re.compile(rf"{_LABEL}process started with pid")
_ENDED = re.compile(rf"{_LABEL}process has (?:finished cleanly|died)")
_DIED = re.compile(rf"{_LABEL}process has died \[pid \d+, exit code (?P<code>-?\d+)")
_DEAD = re.compile(rf"{_LABEL}process has died")
_NODE, _WORD = "__node:=", re.compile(r"\w+")
_RAISED = re.compile(r"^\[[^\]\n]+\] (?P<error>[\w.]*(?:Error|Exception)\b.*)$", re.MULTILINE)


def declared_arguments(workspace: Workspace, package: str, file: str) -> dict[str, Argument]:
    """Return the arguments that an installed launch file declares, by name, as `ros2 launch -s` prints them.

    Raises:
        CheckFailed: the file is not installed, or cannot be read.
    """
    with start(("launch", "--show-args", package, file), sandbox(workspace)) as process:
        process.wait(SHOW_SECONDS)
        output, status = process.output, process.returncode
    require_written(output)
    expect(status == 0, f"`ros2 launch -s {package} {file}` fails: {unreadable(output)}")
    return parse_arguments(output)


def expect_argument(arguments: Mapping[str, Argument], name: str, default: str, *, described: bool = True) -> None:
    """Fail the check unless an argument has the expected default and, if `described`, a description.

    A computed default passes, because only a launch without arguments shows its value.
    """
    names = ", ".join(arguments) or "none"
    expect(name in arguments, f"The launch file declares no argument {name}; it declares: {names}.")
    argument = arguments[name]
    actual = "no default" if argument.default is None else f"the default {argument.default!r}"
    is_correct = argument.default == default or argument.is_computed
    expect(is_correct, f"The argument {name} has {actual}, instead of {default!r}.", fraction=0.5)
    expect(
        bool(argument.description) or not described,
        f"The argument {name} has no description: `ros2 launch -s` would not show its purpose.",
        fraction=0.5,
    )


def settle(harness: LaunchHarness, expected: Collection[str]) -> list[str]:
    """Wait for the nodes that a launch should start; return the nodes in the graph after the wait.

    Returns early if the launch has ended, or if every running program has a node in the graph, and these nodes are the
    expected ones or have not changed for a while. If two nodes should have the same name, `expected` contains it twice.
    """
    state: tuple[object, ...] = ()
    unchanged_since = time.monotonic()

    def is_settled() -> bool:
        nonlocal state, unchanged_since
        nodes, program_count = harness.nodes(), len(harness.programs())
        if nodes == sorted(expected) and program_count == len(expected):
            return True
        if (nodes, program_count) != state or len(nodes) < program_count or not program_count:
            state, unchanged_since = (nodes, program_count), time.monotonic()
        return time.monotonic() - unchanged_since > QUIET_SECONDS

    harness.wait_for(is_settled, START_SECONDS)
    require_written(harness.output)
    return harness.nodes()


def expect_nodes(harness: LaunchHarness, expected: Collection[str]) -> None:
    """Wait for the expected nodes; fail the check unless exactly these run. The message names near misses."""
    nodes = settle(harness, expected)
    if nodes == sorted(expected):
        return
    summary = f"The graph contains {', '.join(nodes)}" if nodes else "No node is running"
    missing = sorted((Counter(expected) - Counter(nodes)).elements())
    extra = sorted((Counter(nodes) - Counter(expected)).elements())
    differences = [f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing"] if missing else []
    differences += [f"{', '.join(extra)} {'is' if len(extra) == 1 else 'are'} not expected"] if extra else []
    near = [f"{other} runs instead of {name}" for name in missing for other in extra if _base(name) == _base(other)]
    reason = failure(harness.output)
    details = f": {'; '.join(near)}" if near else f"; {'; '.join(differences)}"
    parts = [f"{summary}{details}.", reason and f"The launch reported: {reason}"]
    raise CheckFailed(" ".join(filter(None, parts)))


def expect_parameters(harness: LaunchHarness, node: str, expected: Mapping[str, Value]) -> None:
    """Fail the check unless the node with this full name has these values, according to `parameters.same`.

    It waits for the node's parameter services, but not for other nodes: `expect_nodes` does.

    If an exception ends a launch, the launch stops its nodes, and a node may still answer before it ends. That answer
    does not count.
    """
    actual = harness.parameters(node, list(expected))
    if actual is None or _EXCEPTION.search(harness.output):
        raise CheckFailed(
            f"{node} does not answer when it is asked for its parameters. {failure(harness.output)}".strip()
        )
    for name, value in expected.items():
        expect(same(actual[name], value), f"{node} has {name} = {actual[name]!r}, instead of {value!r}.")


def expect_clean_stop(harness: LaunchHarness) -> None:
    """Fail the check unless Ctrl-C ends the launch with exit status 0, and each process ends cleanly.

    If a process had to be killed, a second launch decides. When correct nodes end together, Fast DDS 2.14 deadlocks in
    about one of two thousand cases: `DomainParticipant::set_listener` and a callback of discovery wait for each other.
    Such a node ends neither on SIGINT nor on SIGTERM. A program that ignores Ctrl-C fails both times. A second launch
    also decides if rclpy lost a race, or crashed.
    """
    nodes = harness.nodes()
    died = _died_of_ctrl_c(harness)
    if any(code == KILLED or crashed(int(code)) for _, code in died) or _lost_a_race(harness.output):
        with harness.another() as second:
            expect_nodes(second, nodes)
            died = _died_of_ctrl_c(second)
    statuses = ", ".join(f"{name} with {code}" for name, code in died)
    expect(not died, f"After Ctrl-C, not every process ended cleanly: {statuses}.", fraction=0.5)


def _died_of_ctrl_c(harness: LaunchHarness) -> list[tuple[str, str]]:
    """Interrupt a launch, which then has to end; return the name and exit code of each process that ended badly.

    A node is visible before its constructor has returned, and until then its `main` does not catch Ctrl-C. A node that
    answers a request is spinning, so each node gets one first. The wait for a node that does not answer is short.
    """
    for node in harness.nodes():
        harness.parameters(node, ["use_sim_time"])
    expect_stopped(harness.interrupt(STOP_SECONDS))
    return [(match["name"], match["code"]) for match in _DIED.finditer(harness.output)]


def _lost_a_race(output: str) -> bool:
    """Return whether one of the programs that died did so because rclpy lost a race."""
    lines_of: dict[str, list[str]] = {f"[{match['label']}": [] for match in _DEAD.finditer(output)}
    for line in output.splitlines():
        label, _, text = line.partition("] ")
        if label in lines_of:
            lines_of[label].append(text)
    return any(lost_a_race("\n".join(lines)) for lines in lines_of.values())


def expect_stopped(stop: Stop) -> None:
    """Fail the check unless the launch has ended, with exit status 0, and has left nothing."""
    expect(stop.status is not None, f"It was still running after {STOP_SECONDS:.0f} s and had to be killed.")
    expect(not stop.left, f"It ended, but left a process running: {', '.join(stop.left)[:200]}.")
    expect(stop.status == 0, f"It ended with exit status {stop.status}, instead of 0.")


def started(output: str) -> list[str]:
    """Return the programs that a launch has started according to its output, in order and without their numbers."""
    return [match["name"] for match in _STARTED.finditer(output)]


def ended(output: str) -> list[str]:
    """Return the programs that have ended according to the launch's output, in order and without their numbers."""
    return [match["name"] for match in _ENDED.finditer(output)]


def node_names(output: str, program: str) -> set[str]:
    """Return the names that a launch gave to the nodes of a program that has died.

    They are in the command of the program, which the launch's output repeats.
    """
    names = set()
    for line in output.splitlines():
        if (died := _DEAD.search(line)) and died["name"] == program:
            _, separator, name = line[died.end() :].rpartition(_NODE)
            names |= {match[0]} if separator and (match := _WORD.match(name)) else set()
    return names


def failure(output: str) -> str:
    """Return one line of a launch's output that says why it failed, or an empty string. Paths begin with `ws`."""
    return _PATH.sub(lambda path: _in_workspace(path[0]), _failure_line(output))


def _failure_line(output: str) -> str:
    if caught := _EXCEPTION.search(output):
        return " ".join(caught["reason"].split())
    died = [f"{match['name']} died with exit code {match['code']}" for match in _DIED.finditer(output)]
    errors = [match["error"].strip() for match in _RAISED.finditer(output)]
    if not died:
        # `ros2 launch` ends with a line about a rejected argument or a missing package.
        return _last_line(output) if "error" in _last_line(output).lower() else ""
    return f"{', '.join(died)}{f' ({errors[-1]})' if errors else ''}"


def unreadable(output: str) -> str:
    """Return one line that says why `ros2 launch` could not read a launch file, and where."""
    lines = output.split("\n")
    reasons = (after[3:] for line, after in pairwise(lines) if _NOT_READ in line and after.startswith(" - "))
    reason = next(filter(None, reasons), "") or _last_line(output)
    places = _PLACE.findall(with_source_paths(output))
    if not places or ", line " in reason:
        return reason
    file, line = places[-1]
    return f"{reason} ({file}, line {line})"


def require_written(output: str) -> None:
    """Raise a StudentError if a launch reached a part of the exercise that is still to be written."""
    lines = output.splitlines()
    first = next((number for number, line in enumerate(lines) if "NotImplementedError" in line), None)
    if first is not None:
        sentence = (
            "A part of the launch file is still to be written: "
            "replace the line raise NotImplementedError(...) with your code."
        )
        detail = with_source_paths("\n".join(lines[max(first - 1, 0) : first + 2]))
        raise StudentError(Diagnosis(Kind.UNFINISHED, sentence, detail))


def with_files(
    workspace: Workspace,
    name: str,
    package: str,
    files: Mapping[str, str],
    programs: Mapping[str, str] = MappingProxyType({}),
) -> Workspace:
    """Return a copy of a workspace's install space in which files and programs of a package are replaced.

    Args:
        workspace: the built workspace, which is not changed.
        name: the copy's name, different from that of any other copy.
        package: the package.
        files: the new text of each file, by its path below `share/PACKAGE`.
        programs: the new text of each executable, by its name.
    """
    root = workspace.root.with_name(f"{workspace.root.name}-{name}")  # not in scratch, where students' code may write
    with reading("The files that colcon installed"):
        shutil.copytree(workspace.install, root / "install", symlinks=True)
    prefix = root / "install" / package
    texts = {prefix / "share" / package / path: (text, 0o644) for path, text in files.items()}
    texts |= {prefix / "lib" / package / path: (text, 0o755) for path, text in programs.items()}
    for target, (text, mode) in texts.items():
        with reading(f"The installed {target.relative_to(prefix)}", advice="It has to be a file."):
            target.parent.mkdir(parents=True, exist_ok=True)
            target.unlink(missing_ok=True)
            target.write_text(text)
            target.chmod(mode)
    return replace(workspace, root=root)


def _in_workspace(path: str) -> str:
    """Return a path in a workspace without the folders above it, which are the grader's; any other path as it is."""
    folder = _WORKSPACE.search(path)
    return f"ws{path[folder.end() :]}" if folder else path


def _base(name: str) -> str:
    return name.rpartition("/")[2]


def _last_line(output: str) -> str:
    return next((line.strip() for line in reversed(output.splitlines()) if line.strip()), "it printed nothing")
