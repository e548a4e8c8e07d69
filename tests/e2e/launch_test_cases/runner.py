"""Run launch tests with the installed `launch_testing`, and record their output and exit status.

`python -m tests.e2e.launch_test_cases.runner` prints the records of all calls as YAML. With the real packages, after
`make real-launch`, it wrote `records.yaml`. Each call runs in a fork of this process.
"""

from __future__ import annotations

import importlib
import os
import re
import shlex
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

import yaml

HERE = Path(__file__).parent
RECORDS = HERE / "records.yaml"
TIMEOUT = 120.0  # seconds for a call, on a busy machine
MAX_PARALLEL = 4
CASES = {path.stem: path.read_text() for path in sorted((HERE / "cases").glob("*.py"))}
CASES = {"broken": "def generate_test_description(:\n", **CASES}
CALLS = (
    *(f"pytest test_{name}.py" for name in CASES),
    "pytest good_launch_test.py",
    "pytest test_listener.launch.py",
    "pytest test_parametrized.py --launch-args more:=much",
    "pytest test_good.py -m launch_test",
    "pytest test_good.py -m 'not launch_test'",
    "pytest --collect-only test_good.py test_unmarked.py test_no_function.py",
)
NAMES = {"good_launch_test.py": "good", "test_listener.launch.py": "listener"}
PYTEST = "-c /dev/null -q --tb=short -rfEsxX --show-capture=no -p no:cacheprovider --rootdir .".split()  # noqa: SIM905
PYTEST += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]  # about modules that are imported before the forks
# Parts whose differences between runs or versions of Python have no meaning.
VARIABLE_PARTS = (
    (re.compile(r"Traceback \(most recent call last\):\n(  .*\n)+(.*\n)"), r"\2"),
    (re.compile(r"usage: .*\n( +.*\n)*"), "usage\n"),
    (re.compile(r"in \d+\.\d+s"), "in Ns"),
    (re.compile(r"<object object at \w+>"), "OBJECT"),
    (re.compile(r"(-\d+)(?=[',\s]|$)", re.MULTILINE), "-N"),  # the number in a process's name
    (re.compile(r"^(test\S*) \((.*?)\.test\w*(?:\[.*\])?\)", re.MULTILINE), r"\1 (\2)"),
    (re.compile(r"(Ran 0 tests in Ns\n\n)NO TESTS RAN"), r"\1OK"),
    (re.compile(r"^( *)[~^]+\n", re.MULTILINE), ""),
    (re.compile(r"^(?:\S+\.py|<frozen \S+>):\d+: in \S+\n(?: {4}.*\n)*", re.MULTILINE), ""),
    (re.compile(r"E   .*\n\nDuring handling of the above .*\n+"), ""),
    (re.compile(r"^([=-])\1{9,}$", re.MULTILINE), r"\1\1\1"),
    (re.compile(r"Unknown child process pid .*\n"), ""),
)
# Log lines of the launch, which come from another thread. A command may have several lines.
LOG = re.compile(r"^\[\w+\] \[.*process has died(?s:.*?)'\]\.\n|^(\[\w+\] \[|\[[^\]]+-\d+\] ).*\n", re.MULTILINE)


def start(call: str, folder: Path) -> dict[str, Any]:
    """Start a call in a fork; return its command, process id and folder."""
    arguments = shlex.split(call)
    for argument in arguments:
        if text := CASES.get(NAMES.get(argument, argument.removeprefix("test_").removesuffix(".py"))):
            (folder / argument).write_text(text)
    pid = os.fork()
    if pid == 0:
        os.setsid()
        signal.signal(signal.SIGINT, signal.default_int_handler)
        os.chdir(folder)
        for number, name in ((1, "out"), (2, "err")):
            os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT), number)
        sys.stdout = open(1, "w", buffering=1, closefd=False)  # noqa: SIM115  # they are closed with this process
        sys.stderr = open(2, "w", buffering=1, closefd=False)  # noqa: SIM115
        os._exit(_run(arguments))
    return {"call": call, "pid": pid, "folder": folder}


def _run(arguments: list[str]) -> int:
    import pytest

    return int(pytest.main([*PYTEST, *arguments[1:]]))


def poll(started: dict[str, Any]) -> dict[str, Any] | None:
    """Return the record of a call, or None if it has not ended."""
    pid, status = os.waitpid(started["pid"], os.WNOHANG)
    if not pid:
        return None
    folder: Path = started["folder"]
    record = {"call": started["call"], "status": os.waitstatus_to_exitcode(status)}
    for stream in ("out", "err"):
        text = LOG.sub("", (folder / stream).read_text().replace(str(folder), "HERE"))
        for pattern, replacement in VARIABLE_PARTS:
            text = pattern.sub(replacement, text)
        record[stream] = text
    return record


def records() -> Iterator[dict[str, Any]]:
    """Run all calls, some in parallel; yield their records in order."""
    for name in ("pytest", "launch_testing.test_runner", "launch_testing.asserts", "launch_testing.event_handlers"):
        importlib.import_module(name)
    with tempfile.TemporaryDirectory() as scratch:
        os.environ["ROS_LOG_DIR"] = f"{scratch}/log"
        os.environ.pop("CI", None)  # where CI is set, pytest does not shorten lines of its summary
        waiting, running, records_by_call = list(CALLS), list[dict[str, Any]](), dict[str, dict[str, Any]]()
        deadline = time.monotonic() + TIMEOUT * len(CALLS) / MAX_PARALLEL
        while waiting or running:
            while waiting and len(running) < MAX_PARALLEL:
                (folder := Path(scratch, str(len(waiting)))).mkdir()
                running.append(start(waiting.pop(0), folder))
            for call in list(running):
                if (record := poll(call)) is not None:
                    records_by_call[call["call"]] = record
                    running.remove(call)
            if time.monotonic() > deadline:
                raise TimeoutError(f"{running} did not end")
            time.sleep(0.01)
        yield from (records_by_call[command] for command in CALLS)


class _Readable(yaml.SafeDumper):
    """Writes texts of several lines as YAML blocks."""


_Readable.add_representer(
    str,
    lambda dumper, text: dumper.represent_scalar("tag:yaml.org,2002:str", text, style="|" if "\n" in text else None),
)


def main() -> None:
    """Print the records."""
    version = {distribution.name.replace("-", "_"): distribution.version for distribution in distributions()}.get(
        "launch_testing", "stand-in"
    )
    print(f"# Recorded with launch_testing {version}, Python {sys.version_info[0]}.{sys.version_info[1]}.")
    yaml.dump(list(records()), sys.stdout, Dumper=_Readable, sort_keys=False, width=160, allow_unicode=True)


if __name__ == "__main__":
    importlib.import_module("autograder.ros").activate()
    main()
