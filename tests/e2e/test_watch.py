"""`autograder check --watch` in a student's terminal."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.author.verification.mutants import write_reference
from autograder.notebook.checking import FAILED_BEFORE
from autograder.notebook.watching import WAITING

PACKAGE, EXERCISE = "my_robot_package", "07_best_practices, exercise 1"


@pytest.mark.promise(
    "`autograder check 03_interfaces --exercise 1` checks one exercise.",
    "`autograder check 02_nodes --watch` checks again each time you save a file, and begins with the checks that",
    "Ctrl-C ends it.",
)
def test_a_saved_file_is_checked_again_starting_with_what_failed_until_ctrl_c(tmp_path: Path) -> None:
    write_reference((PACKAGE,), tmp_path / "ws")
    path = tmp_path / "ws/src" / PACKAGE / PACKAGE / "utils/data_processing.py"
    text = path.read_text()
    incomplete = text[: text.index("def mean_distance")]
    command = [str(Path(sys.executable).with_name("autograder")), "check", "07_best_practices"]
    command += ["--exercise", "1", "--watch"]
    with subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as process:
        assert process.stdout is not None

        def summaries() -> list[str]:
            """Return the summaries that it prints until it waits again."""
            assert process.stdout is not None
            lines = iter(process.stdout.readline, "")
            printed = [line.rstrip() for line in iter(lambda: next(lines, WAITING).rstrip(), WAITING)]
            assert not any("Traceback" in line for line in printed), "\n".join(printed)
            return [line for line in printed if "visible checks passed" in line]

        try:
            assert summaries() == [f"{EXERCISE}: 3 of 3 visible checks passed."]
            path.write_text(incomplete)  # as if an editor had not written the rest yet
            assert summaries() == [f"{EXERCISE}: 1 of 3 visible checks passed."]
            path.write_text(text)
            assert summaries() == [
                f"07_best_practices, {FAILED_BEFORE}: 2 of 2 visible checks passed.",
                f"{EXERCISE}: 3 of 3 visible checks passed.",
            ]
            process.send_signal(signal.SIGINT)
            assert (process.stdout.read(), process.wait()) == ("", 0)
        finally:
            process.kill()
