"""Two objects of the node's class in one process, as a student's own tests may create them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from autograder.checking import Workspace
from autograder.checking.probes import calls
from autograder.checks.ch02_nodes.support.contract import PACKAGE

CLASS = "RobotController"
MODULE = f"{PACKAGE}.nodes.robot_controller"
NAMESPACES = ("/first", "/second")
CLEAR_SCAN: dict[str, Any] = {"angle_increment": math.radians(1.0), "range_max": 3.5, "ranges": [3.0] * 360}
MISSING = "AttributeError"  # a module without the class, or a class without the method, may be correct


@dataclass(frozen=True)
class TwoNodes:
    """The results of creating the nodes, of reading a namespace, and of a scan that only the first one receives.

    Attributes:
        creation: the creation of the first node, with a namespace as a keyword argument.
        namespace: the namespace of the first node.
        clearance: the clearance of the second node, which has received no scan.
    """

    creation: calls.StepResult
    namespace: calls.StepResult
    clearance: calls.StepResult

    def argument_problem(self) -> str:
        """Describe what is wrong with a node created with a keyword argument of Node, or return "" if nothing is."""
        call = f"{CLASS}(namespace={NAMESPACES[0]!r})"
        if self.creation.raised == MISSING:
            return ""
        if self.creation.raised:
            return f"{call} raised {self.creation.raised}: {self.creation.message}"
        if self.namespace.value == NAMESPACES[0]:
            return ""
        return f"{call} is in the namespace {self.namespace.value}: pass all keyword arguments on to Node."

    def sharing_problem(self) -> str:
        """Describe how a node that has received no scan uses the scan of another node, or return "" if it does not."""
        if self.creation.raised or self.clearance.raised == MISSING or self.clearance.value is None:
            return ""
        clearance = self.clearance.value
        return f"A {CLASS} that had received no scan used the scan of another node: its clearance was {clearance} m."


def call_two_nodes(workspace: Workspace) -> TwoNodes:
    """Create two nodes in one process, and let the first one receive a scan of a clear way."""
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))
    first, second = (add(calls.call(CLASS, namespace=namespace)) for namespace in NAMESPACES)
    namespace = add(calls.call("get_namespace", on=first))
    scan = add(calls.call("LaserScan", module="sensor_msgs.msg", **CLEAR_SCAN))
    add(calls.call("scan_callback", calls.result_of(scan), on=first))
    clearance = add(calls.call("current_clearance", on=second))
    results = calls.run_steps(workspace, MODULE, *plan.steps, network=True)
    return TwoNodes(results[first], results[namespace], results[clearance])
