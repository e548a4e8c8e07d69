"""A lab in real time that also asks services and sends goals, as another program of the robot would."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor

from autograder.lab import RealtimeLab

ANSWER_SECONDS = 10.0  # of real time, generous for a machine that is busy
_BURST = 50  # messages taken at once before the lab looks at the program again


@dataclass
class Goal:
    """A goal that was sent.

    Attributes:
        accepted: whether the server took it; None while it has not answered.
        feedback: what it has said on the way.
        status: of `action_msgs/GoalStatus` once it has ended, None before.
        result: once it has ended.
    """

    accepted: bool | None = None
    feedback: list[Any] = field(default_factory=list)
    status: int | None = None
    result: Any = None
    handle: Any = None

    def cancel(self) -> Any:
        """Ask the server to cancel it; return the future of its answer."""
        return self.handle.cancel_goal_async()

    def _taken(self, future: Any) -> None:
        self.handle = future.result()
        self.accepted = self.handle.accepted
        if self.accepted:
            self.handle.get_result_async().add_done_callback(self._ended)

    def _ended(self, future: Any) -> None:
        self.status, self.result = future.result().status, future.result().result


class TalkingLab(RealtimeLab):
    """A program in real time whose services and actions are used."""

    def call(self, service_type: Any, name: str, request: Any, seconds: float = ANSWER_SECONDS) -> Any:
        """Return a service's response, None if it is not there or does not answer."""
        client = self._services.get(name) or self.node.create_client(service_type, name)
        self._services[name] = client
        if not self.wait_for(lambda: self._alive() and client.service_is_ready(), seconds):
            return None
        future = client.call_async(request)
        return future.result() if self.wait_for(lambda: self._alive() and future.done(), seconds) else None

    def send_goal(self, action_type: Any, name: str, goal: Any, seconds: float = ANSWER_SECONDS) -> Goal:
        """Send a goal and wait until it is accepted or rejected; `accepted` stays None if nobody answers."""
        client = self._actions.get(name) or ActionClient(self.node, action_type, name)
        self._actions[name] = client
        sent = Goal()
        if self.wait_for(lambda: self._alive() and client.server_is_ready(), seconds):
            future = client.send_goal_async(goal, lambda message: sent.feedback.append(message.feedback))
            future.add_done_callback(sent._taken)
            self.wait_for(lambda: self._alive() and sent.accepted is not None, seconds)
        return sent

    @cached_property
    def _executor(self) -> SingleThreadedExecutor:
        executor = SingleThreadedExecutor(context=self.node.context)
        executor.add_node(self.node)
        return executor

    @cached_property
    def _services(self) -> dict[str, Any]:
        return {}

    @cached_property
    def _actions(self) -> dict[str, Any]:
        return {}

    def _spin(self, timeout: float) -> None:
        """Take what has arrived, answers and feedback included; wait for something at most `timeout` seconds."""
        self._executor.spin_once(timeout_sec=timeout)
        for _ in range(_BURST):
            self._executor.spin_once(timeout_sec=0.0)
