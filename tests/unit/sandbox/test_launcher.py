"""Students' programs receive Ctrl-C, even if the grader was started in the background."""

from __future__ import annotations

import subprocess
import sys

import pytest

CHILD = "import signal; print(signal.getsignal(signal.SIGINT) is signal.SIG_IGN)"
PARENT = f"""
import subprocess, sys
from autograder.run.sandbox.launcher import restore_sigint
if sys.argv[1] == "restore":
    restore_sigint()
subprocess.run([sys.executable, "-c", {CHILD!r}], check=True)
"""


@pytest.mark.parametrize(("mode", "ignores"), [("restore", "False"), ("leave", "True")])
def test_a_program_receives_ctrl_c_even_if_its_grader_is_a_background_job(mode: str, ignores: str) -> None:
    command = ["sh", "-c", 'trap "" INT; exec "$@"', "sh", sys.executable, "-c", PARENT, mode]
    completed = subprocess.run(command, text=True, capture_output=True, check=True)
    assert completed.stdout.strip() == ignores
