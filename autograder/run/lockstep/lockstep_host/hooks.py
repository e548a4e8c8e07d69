"""Hooks into rclpy: they count what the program makes, sends and takes.

Sending and taking are hooked at rclpy's C objects, below services, actions and executors, so no message is missed.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import Any

from rclpy.action import ActionClient, ActionServer
from rclpy.client import Client
from rclpy.clock import Clock, ClockType
from rclpy.impl.implementation_singleton import rclpy_implementation as c
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, qos_profile_action_status_default
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Timer

from . import channels
from .callback_threads import Worker
from .due import is_seen_coming
from .message_counts import NOT_COUNTED, MessageCounts, Reader

_take_message = c.Subscription.take_message
_is_ready = ActionClient.is_ready
_PARTS = {
    "goal": ("send_goal", "SendGoalService"),
    "cancel": ("cancel_goal", "CancelGoalService"),
    "result": ("get_result", "GetResultService"),
}
_FEEDBACK = QoSProfile(depth=10)


class Hooks:
    """The hooks that keep one `MessageCounts`.

    `note` gets the reason why steps are not all that moves the program. `changed` is True when there are endpoints or
    timers that the grader does not know yet, `unpredictable` when the program has what no count and no timer announces.
    """

    def __init__(self, counts: MessageCounts, note: Callable[[str], None]) -> None:
        self.counts = counts
        self._note = note
        self.changed = True
        self.unpredictable = False
        self._written: dict[tuple[int, str], tuple[str, int]] = {}  # a C object's channel and kept depth
        self._served: dict[tuple[int, str], tuple[str, Any]] = {}  # what a C object serves or calls: name, type

    def install(self) -> None:
        """Put the hooks into rclpy."""
        _after(Publisher, "__init__", self._made_publisher)
        _after(Subscription, "__init__", self._made_subscription)
        _after(Client, "__init__", self._made_client)
        _after(Service, "__init__", self._made_service)
        _after(ActionServer, "__init__", self._made_action_server)
        _after(ActionClient, "__init__", self._made_action_client)
        _after(Timer, "__init__", self._made_timer)
        _after(Clock, "create_jump_callback", self._made_jump_callback)
        _after(Node, "add_waitable", self._added_waitable)
        for method in ("publish", "publish_raw"):
            _after(c.Publisher, method, partial(self._wrote, ""))
        _after(c.Client, "send_request", partial(self._asked, ""))
        _after(c.Client, "take_response", partial(self._took, ""))
        _after(c.Service, "service_take_request", partial(self._took, ""))
        _after(c.Service, "service_send_response", partial(self._answered, "", 1))
        for part in _PARTS:
            _after(c.ActionClient, f"send_{part}_request", partial(self._asked, part))
            _after(c.ActionClient, f"take_{part}_response", partial(self._took, part))
            _after(c.ActionServer, f"take_{part}_request", partial(self._took, part))
            _after(c.ActionServer, f"send_{part}_response", partial(self._answered, part, 0))
        for part in ("feedback", "status"):
            _after(c.ActionServer, f"publish_{part}", partial(self._wrote, part))
        _after(c.ActionClient, "take_feedback", partial(self._took, "feedback"))
        c.Subscription.take_message = lambda handle, kind, raw: self._take_message(handle, kind, raw)
        ActionClient.is_ready = _is_ready_but_for_status

    # What was made.

    def _made_publisher(self, publisher: Any, *_: Any, **__: Any) -> None:
        if publisher.topic_name not in NOT_COUNTED:
            channel = channels.publisher_channel(publisher.topic_name, publisher.msg_type, publisher.qos_profile)
            depth = (publisher.qos_profile.depth or 1) if channels.is_transient_local(channel) else 0
            self._written[(publisher.handle.pointer, "")] = channel, depth
            self.changed = True

    def _made_subscription(self, subscription: Any, *_: Any, **__: Any) -> None:
        if subscription.topic_name in NOT_COUNTED:
            self.unpredictable = True
        else:
            qos = subscription.qos_profile
            read = channels.subscription_channels(subscription.topic_name, subscription.msg_type, qos)
            transient_local = qos.durability.name == "TRANSIENT_LOCAL"
            self.counts.add(
                subscription.handle, Reader(subscription, read, depth=qos.depth or 1, transient_local=transient_local)
            )
            self.changed = True

    def _made_client(self, client: Any, *_: Any, **__: Any) -> None:
        self._calls(client, client.handle, "", 0, client.service_name, client.srv_type)

    def _made_service(self, service: Any, *_: Any, **__: Any) -> None:
        self._serves(service, service.handle, "", 0, service.service_name, service.srv_type)

    # The parameters have rclpy's names, since a program may pass them by name.
    def _made_action_server(
        self, server: Any, node: Any, action_type: Any, action_name: str, *_: Any, **options: Any
    ) -> None:
        for index, (part, (service, of)) in enumerate(_PARTS.items()):
            resolved = node.resolve_service_name(f"{action_name}/_action/{service}")
            self._serves(server, server._handle, part, index, resolved, getattr(action_type.Impl, of))
        for part, of, qos in (
            ("feedback", action_type.Impl.FeedbackMessage, options.get("feedback_pub_qos_profile", _FEEDBACK)),
            (
                "status",
                action_type.Impl.GoalStatusMessage,
                options.get("status_pub_qos_profile", qos_profile_action_status_default),
            ),
        ):
            topic = node.resolve_topic_name(f"{action_name}/_action/{part}")
            self._written[(server._handle.pointer, part)] = channels.publisher_channel(topic, of, qos), 0
        server.lockstep_requests = self._requests(server._handle)
        server.lockstep_feedback = self._written[(server._handle.pointer, "feedback")][0]

    def _made_action_client(
        self, client: Any, node: Any, action_type: Any, action_name: str, *_: Any, **options: Any
    ) -> None:
        for index, (part, (service, of)) in enumerate(_PARTS.items()):
            resolved = node.resolve_service_name(f"{action_name}/_action/{service}")
            self._calls(client, client._client_handle, part, 2 + index, resolved, getattr(action_type.Impl, of))
        topic = node.resolve_topic_name(f"{action_name}/_action/feedback")
        qos = options.get("feedback_sub_qos_profile", _FEEDBACK)
        read = channels.subscription_channels(topic, action_type.Impl.FeedbackMessage, qos)
        self.counts.add(client._client_handle, Reader(client, read, part=("feedback", 0), depth=qos.depth or 1))
        client.lockstep_requests = self._requests(client._client_handle)
        client.lockstep_feedback = read

    def _made_timer(self, timer: Any, *_: Any, **__: Any) -> None:
        self.changed = True
        if timer.clock.clock_type != ClockType.ROS_TIME:
            self._note("clock")

    def _made_jump_callback(self, *_: Any, **__: Any) -> None:
        self.unpredictable = True  # it is told by how much each setting of the time moves a clock

    def _added_waitable(self, node: Any, waitable: Any, **_: Any) -> None:
        self.unpredictable |= not is_seen_coming(waitable)

    def _requests(self, handle: Any) -> list[str]:
        return [channels.request(*self._served[(handle.pointer, part)]) for part in _PARTS]

    def _calls(self, entity: Any, handle: Any, part: str, index: int, name: str, kind: Any) -> None:
        self._served[(handle.pointer, part)] = name, kind
        self.counts.add(handle, Reader(entity, (channels.response(name, kind, channels.OWN),), part=(part, index)))
        self.changed = True

    def _serves(self, entity: Any, handle: Any, part: str, index: int, name: str, kind: Any) -> None:
        self._served[(handle.pointer, part)] = name, kind
        self.counts.add(handle, Reader(entity, (channels.request(name, kind),), part=(part, index)))
        self.changed = True

    # What was sent.

    def _wrote(self, part: str, handle: Any, *_: Any, result: Any) -> None:
        there = self._written.get((handle.pointer, part))
        if there is not None:
            self._sent(*there)

    def _asked(self, part: str, handle: Any, *_: Any, result: Any) -> None:
        self._sent(channels.request(*self._served[(handle.pointer, part)]))

    def _answered(self, part: str, index: int, handle: Any, *arguments: Any, result: Any) -> None:
        name, kind = self._served[(handle.pointer, part)]
        self._sent(channels.response(name, kind, channels.client_prefix(arguments[index])))

    def _sent(self, channel: str, depth: int = 0) -> None:
        thread = threading.current_thread()
        if thread is not threading.main_thread() and not isinstance(thread, Worker):
            self._note("thread")
        self.counts.sent(channel, depth)

    # What was taken.

    def _took(self, part: str, handle: Any, *_: Any, result: Any) -> None:
        if result is not None and not (isinstance(result, tuple) and any(value is None for value in result)):
            self.counts.took(handle, part)

    def _take_message(self, handle: Any, kind: Any, raw: bool) -> Any:
        taken = _take_message(handle, kind, raw)
        if taken is None:
            return None
        reader = self.counts.readers.get((handle.pointer, ""))
        if reader is not None and not reader.transient_local and taken[1]["source_timestamp"] < reader.matched_ns:
            return None  # it was on its way when the reader was matched, so whether it comes is up to chance
        self.counts.took(handle, "")
        return taken


def _is_ready_but_for_status(client: Any, wait_set: Any) -> bool:
    """Take a goal's new status at once. Its queue holds one message, so how many come is up to chance."""
    ready = bool(_is_ready(client, wait_set))
    answered = client._is_goal_response_ready or client._is_cancel_response_ready or client._is_result_response_ready
    if ready and not answered and not client._is_feedback_ready:
        taking = client.execute(client.take_data())
        try:
            taking.send(None)
        except StopIteration:
            return False
    return ready


def _after(kind: Any, method: str, then: Callable[..., None]) -> None:
    """Call `then` after each call of a method, with the call's arguments and its result."""
    original = getattr(kind, method)

    def call(self: Any, *arguments: Any, **options: Any) -> Any:
        result = original(self, *arguments, **options)
        then(self, *arguments, **options, result=result)
        return result

    setattr(kind, method, call)
