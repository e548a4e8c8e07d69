"""Run commands of the installed `ros2`, and record the output and exit status of each.

`python -m tests.e2e.ros2_records.runner` runs the commands of `records.yaml`, or of the given groups, and prints the
new records. With the real ros2cli, after `make real-launch`, it wrote `records.yaml`. The nodes of `sample_nodes.py`
answer the commands. Each command runs in a fork of this process, which has already imported the modules that commands
need.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import distributions
from pathlib import Path
from typing import Any, TextIO

import yaml

HERE = Path(__file__).parent
RECORDS = HERE / "records.yaml"
PREFIX = HERE.parent / "launch_cases" / "prefix"
TIMEOUT = 120.0  # seconds for a command, on a busy machine
MAX_PARALLEL = 8
# Groups whose commands change something run one after another; the others run in parallel.
IN_ORDER = ("change",)
# Verbs that inspect the graph have an option for the time of discovery. Commands that list have no condition to wait
# for, and neither do commands with an unknown name.
GRAPH_VERBS = ("node", "topic", "service", "action", "param")
WITHOUT_SPIN_TIME = ("topic pub", "service call", "action send_goal")
# Real commands without the option `--no-daemon`, and those that ask ros2cli's daemon, which already knows the graph.
WITHOUT_DAEMON_OPTION = ("topic hz", "topic bw")
BY_DAEMON = ("service type", "service find", "action list", "action info", "action type", "param")
LIST_SECONDS, NAMED_SECONDS = 5, 60
# The fields of a record that describe the command, and another possible result of the real one.
COMMAND_FIELDS = ("command", "stdin", "files", "until", "lines", "sorted", "or")
# Parts that differ between runs.
VARIABLE_PARTS = (
    (re.compile(r"Traceback \(most recent call last\):\n(  .*\n)+(.*\n)"), r"\2"),
    (re.compile(r"usage: .*\n( +.*\n)*"), "usage\n"),
    (re.compile(r"(\bG?ID: |pid \[?)[0-9a-f.]+"), r"\1ID"),
    (re.compile(r"(hello |<string length: <)\d+"), r"\1N"),
    (re.compile(r"(/(?:parameter_events|rosout) \[.*\]) \d+"), r"\1 N"),  # running commands have these endpoints, too
    (re.compile(r"(sec[:=] ?)\d{2,}"), r"\1N"),
    (re.compile(r"((?:timestamp|sequence_number)'?: )\S+?(,?\n|, |})"), r"\1N\2"),
    (re.compile(r"\d+\.\d{3,}(s?\b)"), r"N\1"),
    (re.compile(r"(std dev: \S+ window: |from )\d+"), r"\1N"),
    (re.compile(r"<launch[\w.]*\.(\w+) object at 0x[0-9a-f]+>"), r"<\1>"),
    (re.compile(r"\d[\d.]* ([KM]?B)\b"), r"N \1"),
    (re.compile(r".*/_ros2cli_.*\n"), ""),  # nodes of commands that run in parallel
    (re.compile(r"(waiting for service to become available|Waiting for at least 1 matching sub.*)\.\.\.\n"), ""),
    # The result does not wait for feedback that is still on its way.
    (re.compile(r"(Feedback:\n(?:[ -].*\n)+\n)(?:Feedback:\n(?:[ -].*\n)+\n)*"), r"\1"),
    (re.compile(r"\[INFO\] \[launch\]: All log files.*\n"), ""),
    (re.compile(r"(Creating|creating|destination directory:).*/([\w.]+)\n"), r"\1 \2\n"),
    (re.compile(r"lib/python3\.\d+"), "lib/python3"),
)


@dataclass
class Running:
    """A command that was started.

    Attributes:
        call: `command` and, where given, `stdin`, `files`, `until` (the output at which SIGINT is sent), `lines` (the
            number of lines that are compared) and `sorted` (whether their order is ignored).
        folder: the folder of its files and streams.
        pid: the process id of its fork.
        deadline: the time by which it must end.
        is_interrupted: whether SIGINT was sent.
    """

    call: Mapping[str, Any]
    folder: Path
    pid: int
    deadline: float
    is_interrupted: bool = False

    @classmethod
    def start(cls, call: Mapping[str, Any], folder: Path) -> Running:
        """Run a command in a fork."""
        (folder / "here").mkdir(parents=True)
        (folder / "in").write_text(call.get("stdin", ""))
        for name, text in call.get("files", {}).items():
            (folder / "here" / name).write_text(text)
        pid = os.fork()
        if pid == 0:
            os.setsid()
            signal.signal(signal.SIGINT, signal.default_int_handler)
            os.chdir(folder / "here")
            for number, (name, mode) in enumerate((("in", os.O_RDONLY), ("out", os.O_WRONLY), ("err", os.O_WRONLY))):
                os.dup2(os.open(folder / name, mode | os.O_CREAT), number)
            os._exit(_ros2(call))
        return cls(call, folder, pid, time.monotonic() + TIMEOUT)

    def poll(self) -> dict[str, Any] | None:
        """Return the record of a command, or None if it has not ended.

        A command gets SIGINT once it has printed `until`, and SIGKILL at its deadline.
        """
        pid, status = os.waitpid(self.pid, os.WNOHANG)
        if not pid:
            if not self.is_interrupted and (until := self.call.get("until")) and until in self._text("out"):
                self.is_interrupted = True
                os.killpg(self.pid, signal.SIGINT)
            if time.monotonic() < self.deadline:
                return None
            os.killpg(self.pid, signal.SIGKILL)  # its record has the status -9 and the output until now
            _, status = os.waitpid(self.pid, 0)
        record = {name: self.call[name] for name in COMMAND_FIELDS if name in self.call}
        record |= {"status": os.waitstatus_to_exitcode(status), "output": self._text("out")}
        if "lines" in self.call:
            record["output"] = "".join(record["output"].splitlines(keepends=True)[: self.call["lines"]])
        if "sorted" in self.call:
            record["output"] = "".join(sorted(record["output"].splitlines(keepends=True)))
        if error := self._text("err"):
            record["error"] = error
        working_folder = self.folder / "here"
        files = {str(path.relative_to(working_folder)) for path in working_folder.rglob("*") if path.is_file()}
        if created := files - set(self.call.get("files", ())):
            record["made"] = sorted(created)
        return record

    def _text(self, stream: str) -> str:
        text = (self.folder / stream).read_text() if (self.folder / stream).exists() else ""
        for folder, name in ((self.folder / "here", "HERE"), (PREFIX, "PREFIX"), (sys.prefix, "ENVIRONMENT")):
            text = text.replace(str(folder), name)
        for pattern, replacement in VARIABLE_PARTS:
            text = pattern.sub(replacement, text)
        return text


def is_stand_in() -> bool:
    """Return whether `ros2` is the stand-in."""
    return importlib.util.find_spec("ros2cli") is None


def _ros2(call: Mapping[str, Any]) -> int:
    """Run the command as the program `ros2` does; return its exit status."""
    main = importlib.import_module("autograder.ros.ros2.main").main
    sys.stdout = open(1, "w", closefd=False)  # noqa: SIM115  # they are closed with this process
    sys.stderr = open(2, "w", buffering=1, closefd=False)  # noqa: SIM115
    sys.argv = ["ros2", *shlex.split(call["command"]), *_spin_time(call)]
    try:
        try:
            outcome = main()
        except SystemExit as error:
            outcome = error.code
        if isinstance(outcome, str):
            print(outcome, file=sys.stderr)
        status = 1 if isinstance(outcome, str) else int(outcome or 0)
    except BaseException:
        sys.excepthook(*sys.exc_info())
        status = 1
    sys.stdout.flush()
    sys.stderr.flush()
    return status


def _spin_time(call: Mapping[str, Any]) -> list[str]:
    arguments = shlex.split(call["command"])
    if arguments[0] not in GRAPH_VERBS or " ".join(arguments[:2]) in WITHOUT_SPIN_TIME:
        return []
    if not is_stand_in():
        if {arguments[0], " ".join(arguments[:2])} & set(BY_DAEMON):
            return []
        no_daemon = [] if " ".join(arguments[:2]) in WITHOUT_DAEMON_OPTION else ["--no-daemon"]
        return [*no_daemon, "--spin-time", str(LIST_SECONDS)]
    listing = arguments[1] in ("list", "find") or call.get("status", 0) != 0
    return ["--spin-time", str(LIST_SECONDS if listing else NAMED_SECONDS)]


def records(groups: Mapping[str, list[Mapping[str, Any]]], scratch: Path) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Run the commands of each group; yield the group's name and records."""
    for group, calls in groups.items():
        waiting, running_by_number = list(enumerate(calls)), dict[int, Running]()
        finished: dict[int, dict[str, Any]] = {}
        while waiting or running_by_number:
            while waiting and len(running_by_number) < (1 if group in IN_ORDER else MAX_PARALLEL):
                number, call = waiting.pop(0)
                running_by_number[number] = Running.start(call, scratch / group / str(number))
            for number, command in list(running_by_number.items()):
                if (record := command.poll()) is not None:
                    finished[number] = record
                    del running_by_number[number]
            time.sleep(0.01)
        yield group, [finished[number] for number in range(len(calls))]


def prepare() -> None:
    """Import the modules that commands need, once for all forks."""
    importlib.import_module("rclpy.action")
    if is_stand_in():
        for name in ("action", "interface", "launch", "node", "param", "pkg", "run", "service", "topic"):
            importlib.import_module(f"autograder.ros.ros2.{name}")
        sys.path.append(str(importlib.import_module("autograder.ros.ros2.main").STANDINS_FOLDER))
    for name in ("rosidl_runtime_py", "example_interfaces.action", "sensor_msgs.msg", "launch"):
        importlib.import_module(name)


def run(out: TextIO, *names: str) -> None:
    """Start the nodes, run the commands of all groups or of the named ones, and write their records."""
    groups = {name: calls for name, calls in yaml.safe_load(RECORDS.read_text()).items() if name in names or not names}
    os.environ["AMENT_PREFIX_PATH"] = f"{PREFIX}{os.pathsep}{os.environ['AMENT_PREFIX_PATH']}"
    with tempfile.TemporaryDirectory() as scratch:
        os.environ["ROS_LOG_DIR"] = f"{scratch}/log"
        with subprocess.Popen(
            [sys.executable, str(HERE / "sample_nodes.py")], stdout=subprocess.PIPE, text=True
        ) as nodes:
            try:
                assert nodes.stdout is not None
                assert nodes.stdout.readline() == "ready\n"
                prepare()
                with _daemon():
                    recorded = dict(records(groups, Path(scratch)))
            finally:
                nodes.terminate()
    version = {distribution.name: distribution.version for distribution in distributions()}.get("ros2cli", "stand-in")
    print(f"# Recorded with ros2cli {version}, Python {sys.version_info[0]}.{sys.version_info[1]}.", file=out)
    yaml.dump(recorded, out, Dumper=_Readable, sort_keys=False, width=160, allow_unicode=True)


@contextmanager
def _daemon() -> Iterator[None]:
    """With the real ros2cli, run its daemon, and wait until it has discovered the nodes."""
    if is_stand_in():
        yield
        return
    ros2 = [sys.executable, "-m", "autograder.ros.ros2"]
    subprocess.run([*ros2, "daemon", "start"], check=True, stdout=subprocess.DEVNULL)
    deadline = time.monotonic() + TIMEOUT
    while b"/lab/count" not in subprocess.run([*ros2, "action", "list"], check=True, stdout=subprocess.PIPE).stdout:
        if time.monotonic() > deadline:
            raise TimeoutError("ros2cli's daemon did not discover the nodes")
    try:
        yield
    finally:
        subprocess.run([*ros2, "daemon", "stop"], check=True, stdout=subprocess.DEVNULL)


class _Readable(yaml.SafeDumper):
    """Writes texts of several lines as YAML blocks, and uses no aliases."""

    def ignore_aliases(self, data: object) -> bool:
        return True


_Readable.add_representer(
    str,
    lambda dumper, text: dumper.represent_scalar("tag:yaml.org,2002:str", text, style="|" if "\n" in text else None),
)


if __name__ == "__main__":
    importlib.import_module("autograder.ros").activate()
    run(sys.stdout, *sys.argv[1:])
