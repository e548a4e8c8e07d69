"""A node's parameters are read over its services. A node without these services, or without a reply, is reported."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tests.e2e.sandbox_support import in_worker_sandbox

NODE = """#!/usr/bin/env python3
import rclpy
from rcl_interfaces.srv import ListParameters
from rclpy.node import Node
from rclpy.task import Future

async def silent(request, response):
    await Future()

rclpy.init()
node = Node('tuned', start_parameter_services=SERVICES)
if not SERVICES:
    node.create_service(ListParameters, '~/list_parameters', silent)
node.declare_parameter('speed', 0.5)
rclpy.spin(node)
"""
FORGED = """#!/usr/bin/env python3
import rclpy
from rcl_interfaces.msg import ParameterValue
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node

def answer(request, response):
    response.values = [ParameterValue(type=200)]
    return response

rclpy.init()
node = Node('tuned', start_parameter_services=False)
node.create_service(GetParameters, '~/get_parameters', answer)
rclpy.spin(node)
"""


def read_parameters(scratch: Path) -> Any:
    from autograder.exceptions import StudentError
    from autograder.harness import RealTimeHarness, SteppedHarness, Workspace
    from autograder.probes.parameters import NodeParameters
    from autograder.ros import activate
    from autograder.suite import CheckFailed

    folder = scratch / "ws" / "install" / "pkg" / "lib" / "pkg"
    folder.mkdir(parents=True)
    (scratch / "home").mkdir()
    for name, services in (("open", "True"), ("closed", "False")):
        (folder / name).write_text(NODE.replace("SERVICES", services))
    (folder / "forged").write_text(FORGED)
    workspace = Workspace(scratch / "ws", activate(), scratch / "home")
    answers: list[Any] = []
    exchanges: list[Any] = []
    for kind in (SteppedHarness, RealTimeHarness):
        with kind(workspace, "pkg", "open") as harness:
            parameters = NodeParameters(harness, "/tuned")
            answer = parameters.change({"speed": "fast"})
            answers.append(
                [sorted(parameters.names()), parameters.values("speed", "mass"), answer.accepted, answer.reason]
            )
            exchanges.append([[row.what, row.name, row.text] for row in workspace.exchanges.take()])
    with SteppedHarness(workspace, "pkg", "closed") as harness:
        parameters = NodeParameters(harness, "/tuned")
        for read in (lambda: parameters.values("speed"), parameters.names):
            try:
                read()
            except CheckFailed as failed:
                answers.append(str(failed))
    exchanges.append([[row.what, row.text] for row in workspace.exchanges.take()])
    with SteppedHarness(workspace, "pkg", "forged") as harness:
        try:
            answers.append(NodeParameters(harness, "/tuned").values("speed"))
        except StudentError as error:
            answers.append(error.diagnosis.sentence)
    return answers, exchanges


def test_parameters_are_read_and_missing_or_invalid_responses_are_reported() -> None:
    (stepped, real, without, silent, forged), (exchanges, real_exchanges, silent_exchanges) = in_worker_sandbox(
        read_parameters
    )
    assert stepped == real
    names, values, accepted, reason = stepped
    assert (names, values, accepted) == (["speed"], {"speed": 0.5}, False)
    assert "Wrong parameter type" in reason
    assert without == "The node has no service /tuned/get_parameters: keep its parameter services enabled."
    assert silent == "The node did not answer a request to /tuned/list_parameters within 5 s."
    assert forged == ("Your node's answer about its parameter speed cannot be read: 200 is not a parameter type.")
    assert exchanges == real_exchanges
    assert exchanges[:2] == [
        ["asked", "/tuned/set_parameters_atomically", "parameters: [{name: 'speed', value: 'fast'}]"],
        ["answered", "/tuned/set_parameters_atomically", f"result: {{successful: False, reason: {stepped[3]!r}}}"],
    ]
    assert silent_exchanges == [["no answer", "within 5 s"], ["asked", "depth: 0"], ["no answer", "within 5 s"]]
