"""Goals that the grader sends to a student's action server."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from action_msgs.msg import GoalInfo, GoalStatus
from action_msgs.srv import CancelGoal

from autograder.harness.grader_node import requested_qos


@dataclass(frozen=True)
class ReceivedMessage:
    """A message from the student's program, and the ROS time of its arrival in s since the program started."""

    seconds: float
    message: Any


@dataclass(eq=False)
class Goal:
    """A goal that was sent to an action server.

    Attributes:
        id: its UUID.
        accepted: whether the server accepted it; None while it has not answered.
        feedback: its feedback messages so far.
        status: the last status that was received, a constant of `action_msgs/GoalStatus`.
        result: the result message once the goal has ended, None before.
        cancelled: whether the server agreed to cancel it; None if it was not asked or has not answered.
    """

    id: Any = None
    accepted: bool | None = None
    feedback: list[ReceivedMessage] = field(default_factory=list)
    status: int = GoalStatus.STATUS_UNKNOWN
    result: Any = None
    cancelled: bool | None = None
    _cancel: Callable[[], None] = lambda: None

    def cancel(self) -> None:
        """Ask the server to cancel the goal. Once the programs have run, `cancelled` is its answer."""
        self._cancel()


class Actions:
    """The action clients of a harness, which consist of plain service clients and subscriptions."""

    def __init__(self, grader_node: Any, arrival_seconds: Callable[[int], float]) -> None:
        self._grader_node = grader_node
        self._arrival_seconds = arrival_seconds
        self._goals: dict[bytes, Goal] = {}
        self._names: set[str] = set()
        self._numbers = itertools.count(1)

    def prepare(self, kind: Any, name: str) -> list[Any]:
        """Create the subscriptions and clients for an action server. Return the clients, which have to be matched."""
        if name not in self._names:
            self._names.add(name)
            feedback, status = f"{name}/_action/feedback", f"{name}/_action/status"
            peers = self._grader_node.publishers_of(feedback)
            self._grader_node.subscribe(
                feedback, kind.Impl.FeedbackMessage, partial(self._on_feedback, feedback), requested_qos(peers)
            )
            self._grader_node.subscribe(status, kind.Impl.GoalStatusMessage, self._on_status, requested_qos([]))
        services = {
            "send_goal": kind.Impl.SendGoalService,
            "cancel_goal": kind.Impl.CancelGoalService,
            "get_result": kind.Impl.GetResultService,
        }
        return [
            self._grader_node.client(service_type, f"{name}/_action/{service}")
            for service, service_type in services.items()
        ]

    def send(self, kind: Any, name: str, goal: Any) -> Goal:
        """Send a goal to a server for which `prepare` was called. Once it is accepted, ask for its result."""
        sent_goal = Goal(GoalInfo().goal_id)
        # A counter instead of a random number, so that all runs are the same.
        sent_goal.id.uuid = list(next(self._numbers).to_bytes(16, "big"))
        self._goals[bytes(sent_goal.id.uuid)] = sent_goal
        request = kind.Impl.SendGoalService.Request(goal_id=sent_goal.id, goal=goal)

        def on_result(response: Any) -> None:
            sent_goal.status, sent_goal.result = response.status, response.result

        def on_response(response: Any) -> None:
            sent_goal.accepted = response.accepted
            if response.accepted:
                sent_goal.status = sent_goal.status or GoalStatus.STATUS_ACCEPTED
                result_request = kind.Impl.GetResultService.Request(goal_id=sent_goal.id)
                self._grader_node.ask(
                    kind.Impl.GetResultService, f"{name}/_action/get_result", result_request, on_result
                )

        def on_cancel_response(response: Any) -> None:
            sent_goal.cancelled = any(info.goal_id == sent_goal.id for info in response.goals_canceling)

        def cancel() -> None:
            cancel_request = CancelGoal.Request()
            cancel_request.goal_info.goal_id = sent_goal.id
            self._grader_node.ask(
                kind.Impl.CancelGoalService, f"{name}/_action/cancel_goal", cancel_request, on_cancel_response
            )

        sent_goal._cancel = cancel
        self._grader_node.ask(kind.Impl.SendGoalService, f"{name}/_action/send_goal", request, on_response)
        return sent_goal

    def _on_feedback(self, topic: str, message: Any, arrived_ns: int) -> None:
        goal = self._goals.get(bytes(message.goal_id.uuid))
        if goal is not None:
            self._grader_node.on_exchange("feedback", topic, message.feedback)
            goal.feedback.append(ReceivedMessage(self._arrival_seconds(arrived_ns), message.feedback))

    def _on_status(self, message: Any, arrived_ns: int) -> None:
        for status in message.status_list:
            goal = self._goals.get(bytes(status.goal_info.goal_id.uuid))
            if goal is not None and goal.result is None:
                goal.status = status.status
