"""After Ctrl-C or a kill, `--resume` grades the rest of a class and reports each changed mark."""

from __future__ import annotations

import json
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from autograder.course_paths import SOLUTIONS

STUDENTS = ("alice", "bob", "carol")


SLEEPS = "import time\n\ntime.sleep(10.0)\n"


@contextmanager
def resume(folder: Path) -> Iterator[subprocess.Popen[str]]:
    """Grade the ungraded submissions of the class in `folder`, one at a time."""
    command = [sys.executable, "-u", "-m", "autograder", "grade", "class", "--assignment", "02_nodes"]
    with subprocess.Popen(
        [*command, "-j", "1", "--resume"],
        cwd=folder,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        # SIGINT is ignored if the tests run as a background job.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as process:
        try:
            yield process
        finally:
            process.kill()  # a failed test must not wait for it


@pytest.mark.promise("Ctrl-C loses nothing")
def test_ctrl_c_ends_a_class_and_resume_continues_it(tmp_path: Path) -> None:
    for student in STUDENTS:
        package = tmp_path / "class" / student / "src" / "my_robot_package"
        package.mkdir(parents=True)
        (package / "package.xml").write_text(f"<package>{student}</package>")
    alice, bob, carol = (tmp_path / "results" / student / "result.json" for student in STUDENTS)
    # Bob's build is running at the time of Ctrl-C.
    package = tmp_path / "class" / "bob" / "src" / "my_robot_package"
    shutil.copytree(SOLUTIONS / "my_robot_package", package, dirs_exist_ok=True)
    (package / "setup.py").write_text(SLEEPS)

    with resume(tmp_path) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("[1/3] alice")
        process.send_signal(signal.SIGINT)
        output = process.stdout.read()
    assert process.returncode == 130
    assert output.endswith(
        "\nStopped. Finished results are in results: the same command with --resume grades the rest.\n"
    )
    assert (alice.is_file(), bob.is_file(), carol.exists()) == (True, True, False)
    before = alice.stat().st_mtime_ns, bob.stat().st_mtime_ns

    with resume(tmp_path) as process:
        output = process.communicate()[0]
    assert process.returncode == 0
    assert "[3/3]" in output
    assert carol.is_file()
    assert (alice.stat().st_mtime_ns, bob.stat().st_mtime_ns) == before


@pytest.fixture(scope="module")
def graded_class(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A class that an earlier version of the suite graded, with one more point for everybody."""
    folder = tmp_path_factory.mktemp("graded")
    for student in STUDENTS[:2]:
        package = folder / "class" / student / "src" / "my_robot_package"
        package.mkdir(parents=True)
        (package / "package.xml").write_text(f"<package>{student}</package>")
    with resume(folder) as process:
        process.communicate()
    for path in (folder / "results").glob("*/result.json"):
        result = json.loads(path.read_text())
        failed = next(check for check in result["checks"] if not check["points"])
        failed["points"], result["score"] = 1.0, result["score"] + 1.0
        path.write_text(json.dumps({**result, "suite_version": "0-0123456789ab"}))
    return folder


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_resume_also_reports_marks_that_changed_before_a_signal(
    graded_class: Path, tmp_path: Path, number: signal.Signals
) -> None:
    folder = Path(shutil.copytree(graded_class, tmp_path / "graded"))
    before = {path: json.loads(path.read_text())["score"] for path in (folder / "results").glob("*/result.json")}
    with resume(folder) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("[1/2] alice")
        process.send_signal(number)
        process.stdout.read()
    assert process.returncode == (130 if number is signal.SIGINT else -number)
    alice = folder / "results" / "alice" / "result.json"
    marks = {path: json.loads(path.read_text())["score"] for path in before}
    assert marks[alice] < before[alice]

    with resume(folder) as process:
        output = process.communicate()[0]
    assert re.findall(r"^(\w+) \(02_nodes\): 1 -> 0$", output, re.MULTILINE) == ["alice", "bob"]
