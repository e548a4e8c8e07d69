"""Asks for a greeting."""

from autograder.checking import Workspace, expect
from autograder.checking.probes import calls


def expect_greeting(workspace: Workspace, given: str, greeting: str) -> None:
    """Fail the check unless the function returns this greeting."""
    (answer,) = calls.calls(workspace, "greeting.greet", calls.call("greet", given))
    said = calls.value(answer, f"greet({given!r})")
    expect(said == greeting, f"greet({given!r}) returned {said!r}, not {greeting!r}.")
