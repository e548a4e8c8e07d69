"""The student's node in the harness."""

from std_msgs.msg import UInt32

from autograder.checking import AutoHarness, Workspace, expect


def expect_beats(workspace: Workspace, seconds: float, count: int) -> None:
    """Fail the check unless the node counts from 1 to `count` within `seconds`."""
    with AutoHarness(workspace, "beat", "beat", subscribes={"/beat": UInt32}) as node:
        node.run(seconds)
        numbers = [stamped.message.data for stamped in node.messages("/beat", since=0.0)]
    expect(numbers == list(range(1, count + 1)), f"In {seconds} s it published {numbers}, not 1 to {count}.")
