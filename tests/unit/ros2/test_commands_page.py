"""Each command of the students' page is one that `ros2` takes."""

from __future__ import annotations

import re
import shlex

import pytest

from autograder.course_paths import CHAPTERS
from autograder.ros.ros2.main import COMMANDS
from autograder.ros.ros2.parsing import parse

PAGE = CHAPTERS / "ros2-commands.md"
TYPED = sorted(set(re.findall(r"`ros2 ([^`]+)`", PAGE.read_text(encoding="utf-8"))))


def test_the_commands_page_has_every_verb_that_the_course_uses() -> None:
    used = {
        match
        for notebook in CHAPTERS.glob("*/*.ipynb")
        for match in re.findall(r"ros2 (param|topic|node|service|action|interface|pkg) ([a-z_]+)", notebook.read_text())
    }
    verbs = {tuple(command.split()[:2]) for command in TYPED}
    missing = {(command, verb) for command, verb in used if (command, verb) not in verbs}
    assert missing <= {("param", "load"), ("pkg", "prefix"), ("pkg", "list")}, missing


@pytest.mark.parametrize("command", TYPED)
def test_a_command_of_the_page_is_understood(command: str) -> None:
    words = shlex.split(command)
    run, _ = parse(COMMANDS, words)
    assert callable(run)
