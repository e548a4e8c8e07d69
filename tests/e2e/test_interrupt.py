"""Ctrl-C while a class is graded: what has begun is graded to its end, the rest is left for `--resume`."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

STUDENTS = ("alice", "bob", "carol")


def resume(folder: Path) -> subprocess.Popen[str]:
    """Begin to grade what is not graded of the class in `folder`, one at a time."""
    command = [sys.executable, "-u", "-m", "autograder", "grade", "class", "--assignment", "01_package_structure"]
    return subprocess.Popen(
        [*command, "-j", "1", "--resume"],
        cwd=folder,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        # Whoever runs the tests in the background has it ignored.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


def test_ctrl_c_ends_a_class_and_resume_goes_on(tmp_path: Path) -> None:
    for student in STUDENTS:
        package = tmp_path / "class" / student / "src" / "my_robot_package"
        package.mkdir(parents=True)
        (package / "package.xml").write_text(f"<package>{student}</package>")
    alice, bob, carol = (tmp_path / "results" / student / "result.json" for student in STUDENTS)
    # Whoever reads a named pipe waits for its writer: bob has begun, and does not end before Ctrl-C.
    bob.parent.mkdir(parents=True)
    os.mkfifo(bob)

    with resume(tmp_path) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("[1/3] alice")
        process.send_signal(signal.SIGINT)
        bob.write_text("no result")
        said = process.stdout.read()
    assert process.returncode == 130
    assert said.endswith("\nStopped. What is graded is in results: the same command with --resume grades the rest.\n")
    assert (alice.is_file(), bob.is_file(), carol.exists()) == (True, True, False)
    before = alice.stat().st_mtime_ns, bob.stat().st_mtime_ns

    with resume(tmp_path) as process:
        said = process.communicate()[0]
    assert process.returncode == 0
    assert "[3/3]" in said
    assert carol.is_file()
    assert (alice.stat().st_mtime_ns, bob.stat().st_mtime_ns) == before
