"""Asks for a greeting."""

from autograder.harness import Workspace
from autograder.probes.calls import call, calls, value
from autograder.suite import expect


def expect_greeting(workspace: Workspace, given: str, greeting: str) -> None:
    """Fail the check unless the function returns this greeting."""
    (answer,) = calls(workspace, "greeting.greet", call("greet", given))
    said = value(answer, f"greet({given!r})")
    expect(said == greeting, f"greet({given!r}) returned {said!r}, not {greeting!r}.")
