"""Run launch descriptions with the installed `launch`, and record their output and events.

`python -m tests.e2e.launch_cases.runner` prints the records of all cases as YAML. With the real packages, after `make
real-launch`, it wrote `records.yaml`. Each case runs in a fork of this process.
"""

from __future__ import annotations

import json
import os
import re
import select
import signal
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

import yaml

HERE = Path(__file__).parent
RECORDS = HERE / "records.yaml"
DISTRIBUTIONS = ("launch", "launch_ros", "launch_xml", "launch_yaml")
TIMEOUT = 60.0  # seconds for a case, on a busy machine

PYTHON = """
import os, signal
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.event_handlers import *
from launch.events import matches_action
from launch.events import Shutdown as ShutdownEvent
from launch.events.process import *
from launch.launch_description_sources import *
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.descriptions import ParameterFile, ParameterValue
from launch_ros.substitutions import *

HERE = os.path.dirname(__file__)

def generate_launch_description():
    return LaunchDescription([
{entities}
    ])
"""
# Parts whose differences between runs or implementations have no meaning.
VARIABLE_PARTS = (
    (re.compile(r"(pid \[?)\d+"), r"\1PID"),
    (re.compile(r"<launch[\w.]*\.(\w+) object at 0x[0-9a-f]+>"), r"<\1>"),
    (re.compile(r"/tmp/\S*launch_params_\w+(/\w+)?"), "PARAMETER_FILE"),
    (re.compile(r" !!python/tuple"), ""),
    (re.compile(r"\t\* [A-Z_]+\n"), ""),  # the tokens that lark expected, in any order
    (re.compile(r"lib/python3\.\d+"), "lib/python3"),
    (re.compile(r"Traceback \(most recent call last\):\n(  .*\n)+(.*\n)\n?"), r"\2"),
)
# launch may print this output before or after its message that the process has ended.
PROCESS_OUTPUT = re.compile(r"\[[^\]]+-\d+\] ")
# Events whose number varies: output arrives in pieces, a completion needs a handler, and launch itself uses timers.
VARYING_EVENTS = tuple(
    f"launch.events.{name}"
    for name in ("process.ProcessStdout", "process.ProcessStderr", "ExecutionComplete", "TimerEvent")
)
START = ("[INFO] [launch]: All log files can be found", "[INFO] [launch]: Default logging verbosity")
PRESSED = "pressed"
MARK = "\0events "


@dataclass(frozen=True)
class Case:
    """A launch description to run.

    Attributes:
        name: the behaviour that it shows.
        text: the launch file.
        suffix: the end of the file's name: `py`, `xml` or `yaml`.
        arguments: launch arguments.
        ctrl_c: whether all its processes get SIGINT, as from a terminal, as soon as the file `pressed` exists.
        files: files beside the launch file, by name.
    """

    name: str
    text: str
    suffix: str
    arguments: Mapping[str, str] = field(default_factory=dict)
    ctrl_c: bool = False
    files: Mapping[str, str] = field(default_factory=dict)


def cases() -> dict[str, Case]:
    """Return the cases of the folder `cases` by their names."""
    cases_by_name: dict[str, Case] = {}
    for path in sorted((HERE / "cases").glob("*.yaml")):
        for title, case in yaml.safe_load(path.read_text()).items():
            name = f"{path.stem}: {title}"
            (suffix,) = {"python", "xml", "yaml"} & set(case)
            text = case.pop(suffix)
            if suffix == "python":
                text, suffix = PYTHON.replace("{entities}", text), "py"
            cases_by_name[name] = Case(name, text, suffix, **case)
    return cases_by_name


def record(case: Case, scratch: Path) -> dict[str, Any]:
    """Run a case in a fork; return its exit status, its lines of output and the names of its events."""
    for name, text in case.files.items():
        path = scratch / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)
    file = scratch / f"case.launch.{case.suffix}"
    file.write_text(case.text)
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.setsid()
        os.close(reading)
        for number in (1, 2):
            os.dup2(writing, number)
        status = 99
        try:
            status = _launch(case, file)
        finally:
            sys.stdout.flush()
            os._exit(status)
    os.close(writing)
    output = _read(reading, child, scratch / PRESSED if case.ctrl_c else None)
    os.close(reading)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    text, _, events = output.partition(MARK)
    lines = [line for line in _normalized(text, scratch).splitlines() if not line.startswith(START)]
    process_lines = [line for line in lines if PROCESS_OUTPUT.match(line)]
    log = [line for line in lines if line not in process_lines]
    return {"status": status, "log": log, "written": process_lines, "events": json.loads(events or "[]")}


def _launch(case: Case, file: Path) -> int:
    """Run a file as `ros2 launch FILE` does, and record the events."""
    import launch
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    events: list[str] = []

    def note(event: Any) -> bool:
        if event.name not in VARYING_EVENTS:
            events.append(event.name.removeprefix("launch.events."))
        return False

    # A terminal sends SIGINT to all processes. Without one, launch sends it.
    service = launch.LaunchService(argv=[], noninteractive=not case.ctrl_c)
    service.context.register_event_handler(launch.EventHandler(matcher=note, entities=None))
    source = AnyLaunchDescriptionSource(str(file))
    include = launch.actions.IncludeLaunchDescription(source, launch_arguments=case.arguments.items())
    service.include_launch_description(launch.LaunchDescription([include]))
    status = service.run()
    sys.stdout.flush()
    print(f"{MARK}{json.dumps(events)}", flush=True)
    return int(status)


def is_idle(pid: int) -> bool:
    """Return whether a launch waits for events, as it does when a person presses Ctrl-C; always true for the stand-in.

    In the real launch, Ctrl-C raises KeyboardInterrupt in the code that runs at that moment. If the launch thereby
    misses the start or the end of a process, it waits for that process forever.
    """
    import launch

    return "standins" in str(launch.__file__) or "poll" in Path(f"/proc/{pid}/wchan").read_text()


def _read(reading: int, child: int, ctrl_c: Path | None) -> str:
    """Return the output of a case; send SIGINT as soon as the file `ctrl_c` exists."""
    output, deadline = b"", time.monotonic() + TIMEOUT
    while time.monotonic() < deadline:
        if ctrl_c is not None and ctrl_c.exists() and is_idle(child):
            ctrl_c = None
            os.killpg(child, signal.SIGINT)
        if not select.select([reading], [], [], 0.05)[0]:
            continue
        chunk = os.read(reading, 65536)
        if not chunk:
            return output.decode()
        output += chunk
    os.killpg(child, signal.SIGKILL)
    return output.decode() + "\nIT DID NOT END"


def _normalized(text: str, scratch: Path) -> str:
    for folder, name in ((scratch, "HERE"), (HERE / "prefix", "PREFIX"), (sys.prefix, "ENVIRONMENT")):
        text = text.replace(str(folder), name)
    for pattern, replacement in VARIABLE_PARTS:
        text = pattern.sub(replacement, text)
    return text


def records() -> Iterator[tuple[str, dict[str, Any]]]:
    """Run all cases; yield their names and records."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["ROS_LOG_DIR"] = f"{folder}/log"
        os.environ["AMENT_PREFIX_PATH"] = f"{HERE / 'prefix'}{os.pathsep}{os.environ.get('AMENT_PREFIX_PATH', '')}"
        import launch_ros.actions  # noqa: F401  # imported once for all forks
        import launch_xml
        import launch_yaml  # noqa: F401

        del launch_xml
        for number, (name, case) in enumerate(cases().items()):
            scratch = Path(folder, str(number))
            scratch.mkdir()
            yield name, record(case, scratch)


def main() -> int:
    """Print the records."""
    versions = {distribution.name.replace("-", "_"): distribution.version for distribution in distributions()}
    recorded_with = [f"{name} {versions.get(name, 'stand-in')}" for name in DISTRIBUTIONS]
    print(f"# Recorded with {', '.join(recorded_with)}, Python {sys.version_info[0]}.{sys.version_info[1]}.")
    print(yaml.safe_dump(dict(records()), sort_keys=False, width=160, allow_unicode=True), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
