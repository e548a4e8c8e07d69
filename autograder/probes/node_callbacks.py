"""What nodes that live side by side in one process publish when their callbacks are called in turn."""

from __future__ import annotations

from collections.abc import Sequence

from autograder.probes.calls import Plan, Step, call, calls, look, made
from autograder.run.workspace import Workspace

PUBLISH = "rclpy.publisher.Publisher.publish"


def published(
    workspace: Workspace,
    module: str,
    nodes: Sequence[Step],
    turns: Sequence[tuple[int, str, Step | None]],
) -> list[str]:
    """Make nodes, then call their callbacks in turn; return what each call published, as text.

    Args:
        workspace: where the module is installed.
        module: the student's module that has the nodes' classes.
        nodes: the calls that make the nodes. All are made before the first callback.
        turns: the number of a node, the name of its callback, and the call that makes the message for it, or None.

    Returns:
        For each turn, the `repr` of what was published; no message is in it if the callback does not exist.
    """
    plan = Plan()
    plan.add(call("init", module="rclpy"))
    publish = plan.add(call("start", on=plan.add(call("patch", PUBLISH, module="unittest.mock"))))
    numbers = [plan.add(node) for node in nodes]
    shown = []
    for number, callback, message in turns:
        arguments = () if message is None else (made(plan.add(message)),)
        plan.add(call("reset_mock", on=publish))
        plan.add(Step(callback, arguments, on=numbers[number], begun=True))
        sent = plan.add(look("call_args_list", on=publish))
        shown.append(plan.add(call("repr", made(sent), module="builtins")))
    outcomes = calls(workspace, module, *plan.steps, network=True)
    texts = (outcomes[step].value for step in shown)
    return [text if isinstance(text, str) else "" for text in texts]
