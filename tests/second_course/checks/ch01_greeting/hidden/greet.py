"""Greetings of random names."""

import random

from autograder.checking import Workspace, group, hint
from autograder.checks.ch01_greeting.support.asking import expect_greeting

check = group("greet")
NAMES = ("Karel", "Grace", "Unimate", "Elektro")


@check(points=2, covers="greets")
@hint("An f-string puts a name into a text.")
def test_greets(workspace: Workspace, draw: random.Random) -> None:
    """It greets each robot by its name."""
    name = draw.choice(NAMES)
    expect_greeting(workspace, name, f"Hello, {name}!")


@check(points=1, covers="strips", after=("greets",))
@hint("str.strip() removes the spaces.")
def test_strips(workspace: Workspace, draw: random.Random) -> None:
    """It removes the spaces around a name."""
    name = draw.choice(NAMES)
    expect_greeting(workspace, f"  {name} ", f"Hello, {name}!")
