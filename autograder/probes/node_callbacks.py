"""Calls callbacks of several nodes in turn, in one process, and returns what each call published."""

from __future__ import annotations

from collections.abc import Sequence

from autograder.probes.calls import Plan, Step, attribute, call, result_of, run_steps
from autograder.run.workspace import Workspace

PUBLISH = "rclpy.publisher.Publisher.publish"


def published(
    workspace: Workspace,
    module: str,
    nodes: Sequence[Step],
    turns: Sequence[tuple[int, str, Step | None]],
) -> list[str]:
    """Create nodes, then call their callbacks in turn; return the messages that each call published, as text.

    Args:
        workspace: the workspace in which the module is installed.
        module: the student's module that defines the nodes' classes.
        nodes: the calls that create the nodes. All are created before the first callback is called.
        turns: for each turn, the number of a node, the name of its callback, and the call that creates the message
            for it, or None.

    Returns:
        For each turn, the `repr` of the published messages. If the callback does not exist, there are none.
    """
    plan = Plan()
    plan.add(call("init", module="rclpy"))
    publish = plan.add(call("start", on=plan.add(call("patch", PUBLISH, module="unittest.mock"))))
    numbers = [plan.add(node) for node in nodes]
    steps = []
    for number, callback, message in turns:
        arguments = () if message is None else (result_of(plan.add(message)),)
        plan.add(call("reset_mock", on=publish))
        plan.add(Step(callback, arguments, on=numbers[number], runs_coroutine=True))
        sent = plan.add(attribute("call_args_list", on=publish))
        steps.append(plan.add(call("repr", result_of(sent), module="builtins")))
    outcomes = run_steps(workspace, module, *plan.steps, network=True)
    texts = (outcomes[step].value for step in steps)
    return [text if isinstance(text, str) else "" for text in texts]
