"""The student's node in the harness."""

from std_msgs.msg import UInt32

from autograder.checking import AutoHarness, Workspace, expect


def expect_beats(workspace: Workspace, seconds: float, count: int) -> None:
    """Fail the check unless the node, left alone for so long, counts to this number."""
    with AutoHarness(workspace, "beat", "beat", subscribes={"/beat": UInt32}) as node:
        node.run(seconds)
        heard = [stamped.message.data for stamped in node.messages("/beat", since=0.0)]
    expect(heard == list(range(1, count + 1)), f"In {seconds} s it published {heard}, not 1 to {count}.")
