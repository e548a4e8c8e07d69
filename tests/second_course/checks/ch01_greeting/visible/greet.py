"""One greeting."""

from autograder.checking import Workspace, group, hint
from autograder.checks.ch01_greeting.support.asking import expect_greeting

check = group("greet")


@check(points=1, covers="greets")
@hint("An f-string puts a name into a text.")
def test_greets_one(workspace: Workspace) -> None:
    """It greets a robot."""
    expect_greeting(workspace, "Ada", "Hello, Ada!")
