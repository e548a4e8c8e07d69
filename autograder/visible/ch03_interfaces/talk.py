"""A lab in real time with a voice: it asks services and sends goals, as another program of the robot would."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any, TypeVar

import rclpy
from rclpy.action import ActionClient
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from autograder.lab import RealtimeLab

NAME = "grader_voice"
ANSWER_SECONDS = 10.0  # of real time, generous for a machine that is busy
_LISTEN = 0.01  # s of real time between two looks at what has come
_BURST = 50  # messages taken at once before the lab looks at the program again

AnyTalkingLab = TypeVar("AnyTalkingLab", bound="TalkingLab")


@dataclass
class Submission:
    """A goal that was sent.

    Attributes:
        accepted: whether the server took it; None while it has not answered.
        feedback: what it has said on the way.
        status: of `action_msgs/GoalStatus` once it has ended, None before.
        result: once it has ended.
        cancelled: whether the server agreed to cancel it; None while it was not asked or has not answered.
    """

    accepted: bool | None = None
    feedback: list[Any] = field(default_factory=list)
    status: int | None = None
    result: Any = None
    cancelled: bool | None = None
    _handle: Any = None

    def cancel(self) -> None:
        """Ask the server to cancel it."""
        self._handle.cancel_goal_async().add_done_callback(self._answered)

    def _answered(self, future: Any) -> None:
        self.cancelled = bool(future.result().goals_canceling)

    def _taken(self, future: Any) -> None:
        self._handle = future.result()
        self.accepted = self._handle.accepted
        if self.accepted:
            self._handle.get_result_async().add_done_callback(self._ended)

    def _ended(self, future: Any) -> None:
        self.status, self.result = future.result().status, future.result().result


class TalkingLab(RealtimeLab):
    """A program in real time whose services and actions are used."""

    _voice_context: Context | None = None  # until the program is up

    def __enter__(self: AnyTalkingLab) -> AnyTalkingLab:
        super().__enter__()
        self._voice_context = Context()
        rclpy.init(args=[], context=self._voice_context, domain_id=self.node.context.get_domain_id())
        self.voice = Node(NAME, context=self._voice_context, enable_rosout=False, start_parameter_services=False)
        self._voice_executor = SingleThreadedExecutor(context=self._voice_context)
        self._voice_executor.add_node(self.voice)
        self._known: dict[str, Any] = {}
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._voice_context is not None:
            self.voice.destroy_node()
            self._voice_context.try_shutdown()
        super().__exit__(kind, error, trace)

    def ask_service(self, service_type: Any, name: str, request: Any, seconds: float = ANSWER_SECONDS) -> Any:
        """Return a service's response, None if it is not there or does not answer."""
        client = self._known.get(name) or self.voice.create_client(service_type, name)
        self._known[name] = client
        if not self.listen_until(client.service_is_ready, seconds):
            return None
        future = client.call_async(request)
        return future.result() if self.listen_until(future.done, seconds) else None

    def submit(self, action_type: Any, name: str, goal: Any, seconds: float = ANSWER_SECONDS) -> Submission:
        """Send a goal and wait until it is accepted or rejected; `accepted` stays None if nobody answers."""
        client = self._known.get(name) or ActionClient(self.voice, action_type, name)
        self._known[name] = client
        sent = Submission()
        if self.listen_until(client.server_is_ready, seconds):
            future = client.send_goal_async(goal, lambda message: sent.feedback.append(message.feedback))
            future.add_done_callback(sent._taken)
            self.listen_until(lambda: sent.accepted is not None, seconds)
        return sent

    def listen_until(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Let the program live on until a condition holds, at most so long; return whether it does."""
        end = self.seconds + seconds
        while not condition() and self.seconds < end:
            self.run(_LISTEN)
        return condition()

    def step(self, dt_ns: int) -> None:
        """Listen for `dt_ns` nanoseconds of real time, to answers and feedback, too."""
        super().step(dt_ns)
        for _ in range(_BURST):
            self._voice_executor.spin_once(timeout_sec=0.0)
