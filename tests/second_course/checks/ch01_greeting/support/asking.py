"""A call of the student's function."""

from autograder.checking import Workspace, expect
from autograder.checking.probes import calls


def expect_greeting(workspace: Workspace, given: str, greeting: str) -> None:
    """Fail the check unless the function returns `greeting` for the name `given`."""
    (answer,) = calls.run_steps(workspace, "greeting.greet", calls.call("greet", given))
    returned = calls.value(answer, f"greet({given!r})")
    expect(returned == greeting, f"greet({given!r}) returned {returned!r}, not {greeting!r}.")
