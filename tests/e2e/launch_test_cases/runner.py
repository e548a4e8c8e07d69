"""Runs launch tests with whichever `launch_testing` is installed, and records their output and exit status.

`python -m tests.e2e.launch_test_cases.runner` prints the records of all calls as YAML. The file `records.yaml` was made
so with the real packages: `make real-launch`, then this program. Each call is run by a fork of this process.
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
SECONDS = 120.0  # for one call, on a busy machine
TOGETHER = 4
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
PYTEST += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]  # of what was imported for all forks
# What differs from run to run, or from one Python to another without any meaning.
CHANGING = (
    (re.compile(r"Traceback \(most recent call last\):\n(  .*\n)+(.*\n)"), r"\2"),
    (re.compile(r"usage: .*\n( +.*\n)*"), "usage\n"),
    (re.compile(r"in \d+\.\d+s"), "in Ns"),
    (re.compile(r"<object object at \w+>"), "OBJECT"),
    (re.compile(r"(-\d+)(?=[',\s]|$)", re.MULTILINE), "-N"),  # a process's number
    (re.compile(r"^(test\S*) \((.*?)\.test\w*(?:\[.*\])?\)", re.MULTILINE), r"\1 (\2)"),
    (re.compile(r"(Ran 0 tests in Ns\n\n)NO TESTS RAN"), r"\1OK"),
    (re.compile(r"^( *)[~^]+\n", re.MULTILINE), ""),
    (re.compile(r"^(?:\S+\.py|<frozen \S+>):\d+: in \S+\n(?: {4}.*\n)*", re.MULTILINE), ""),
    (re.compile(r"E   .*\n\nDuring handling of the above .*\n+"), ""),
    (re.compile(r"^([=-])\1{9,}$", re.MULTILINE), r"\1\1\1"),
    (re.compile(r"Unknown child process pid .*\n"), ""),
)
# What the launch logs, in another thread than the tests'; a command may have several lines.
LOG = re.compile(r"^\[\w+\] \[.*process has died(?s:.*?)'\]\.\n|^(\[\w+\] \[|\[[^\]]+-\d+\] ).*\n", re.MULTILINE)


def record(call: str, folder: Path) -> dict[str, Any]:
    """Run a call in a fork; return its exit status and what it printed on both streams."""
    words = shlex.split(call)
    for word in words:
        if text := CASES.get(NAMES.get(word, word.removeprefix("test_").removesuffix(".py"))):
            (folder / word).write_text(text)
    pid = os.fork()
    if pid == 0:
        os.setsid()
        signal.signal(signal.SIGINT, signal.default_int_handler)
        os.chdir(folder)
        for number, name in ((1, "out"), (2, "err")):
            os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT), number)
        sys.stdout = open(1, "w", buffering=1, closefd=False)  # noqa: SIM115  # they end with this process
        sys.stderr = open(2, "w", buffering=1, closefd=False)  # noqa: SIM115
        os._exit(_run(words))
    return {"call": call, "pid": pid, "folder": folder}


def _run(words: list[str]) -> int:
    import pytest

    return int(pytest.main([*PYTEST, *words[1:]]))


def finished(started: dict[str, Any]) -> dict[str, Any] | None:
    """Return the record of a call that has ended."""
    pid, status = os.waitpid(started["pid"], os.WNOHANG)
    if not pid:
        return None
    folder: Path = started["folder"]
    found = {"call": started["call"], "status": os.waitstatus_to_exitcode(status)}
    for stream in ("out", "err"):
        text = LOG.sub("", (folder / stream).read_text().replace(str(folder), "HERE"))
        for pattern, steady in CHANGING:
            text = pattern.sub(steady, text)
        found[stream] = text
    return found


def records() -> Iterator[dict[str, Any]]:
    """Run all calls, some at a time; yield their records in order."""
    for name in ("pytest", "launch_testing.test_runner", "launch_testing.asserts", "launch_testing.event_handlers"):
        importlib.import_module(name)
    with tempfile.TemporaryDirectory() as scratch:
        os.environ["ROS_LOG_DIR"] = f"{scratch}/log"
        os.environ.pop("CI", None)  # pytest shortens no line of its summary where CI is set
        waiting, running, found = list(CALLS), list[dict[str, Any]](), dict[str, dict[str, Any]]()
        deadline = time.monotonic() + SECONDS * len(CALLS) / TOGETHER
        while waiting or running:
            while waiting and len(running) < TOGETHER:
                (folder := Path(scratch, str(len(waiting)))).mkdir()
                running.append(record(waiting.pop(0), folder))
            for one in list(running):
                if (done := finished(one)) is not None:
                    found[one["call"]] = done
                    running.remove(one)
            if time.monotonic() > deadline:
                raise TimeoutError(f"{running} did not end")
            time.sleep(0.01)
        yield from (found[call] for call in CALLS)


class _Readable(yaml.SafeDumper):
    """Writes texts of several lines as YAML blocks."""


_Readable.add_representer(
    str,
    lambda dumper, text: dumper.represent_scalar("tag:yaml.org,2002:str", text, style="|" if "\n" in text else None),
)


def main() -> None:
    """Print the records."""
    version = {one.name.replace("-", "_"): one.version for one in distributions()}.get("launch_testing", "stand-in")
    print(f"# Recorded with launch_testing {version}, Python {sys.version_info[0]}.{sys.version_info[1]}.")
    found = list(records())
    yaml.dump(found, sys.stdout, Dumper=_Readable, sort_keys=False, width=160, allow_unicode=True)


if __name__ == "__main__":
    importlib.import_module("autograder.ros").activate()
    main()
