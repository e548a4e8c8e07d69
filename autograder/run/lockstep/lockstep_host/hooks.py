"""Hooks into rclpy that count the endpoints that the program creates, and the messages that it sends and takes.

Sending and taking are hooked at rclpy's C objects, below services, actions and executors, so that all messages count.
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
from .due import is_predictable
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
    """The hooks that update one `MessageCounts`.

    `note` is called with the reason why the program may also run between steps. `changed` is True if the grader does
    not know all endpoints and timers yet. `unpredictable` is True if anything except messages and timers may make the
    program run.
    """

    def __init__(self, counts: MessageCounts, note: Callable[[str], None]) -> None:
        self.counts = counts
        self._note = note
        self.changed = True
        self.unpredictable = False
        # The channel of a C object, and the number of messages that it keeps.
        self._publisher_channels: dict[tuple[int, str], tuple[str, int]] = {}
        # The name and the type of the service that a C object serves or calls.
        self._services: dict[tuple[int, str], tuple[str, Any]] = {}

    def install(self) -> None:
        """Install the hooks in rclpy."""
        _after(Publisher, "__init__", self._on_new_publisher)
        _after(Subscription, "__init__", self._on_new_subscription)
        _after(Client, "__init__", self._on_new_client)
        _after(Service, "__init__", self._on_new_service)
        _after(ActionServer, "__init__", self._on_new_action_server)
        _after(ActionClient, "__init__", self._on_new_action_client)
        _after(Timer, "__init__", self._on_new_timer)
        _after(Clock, "create_jump_callback", self._on_new_jump_callback)
        _after(Node, "add_waitable", self._on_new_waitable)
        for method in ("publish", "publish_raw"):
            _after(c.Publisher, method, partial(self._on_published, ""))
        _after(c.Client, "send_request", partial(self._on_request_sent, ""))
        _after(c.Client, "take_response", partial(self._on_taken, ""))
        _after(c.Service, "service_take_request", partial(self._on_taken, ""))
        _after(c.Service, "service_send_response", partial(self._on_response_sent, "", 1))
        for part in _PARTS:
            _after(c.ActionClient, f"send_{part}_request", partial(self._on_request_sent, part))
            _after(c.ActionClient, f"take_{part}_response", partial(self._on_taken, part))
            _after(c.ActionServer, f"take_{part}_request", partial(self._on_taken, part))
            _after(c.ActionServer, f"send_{part}_response", partial(self._on_response_sent, part, 0))
        for part in ("feedback", "status"):
            _after(c.ActionServer, f"publish_{part}", partial(self._on_published, part))
        _after(c.ActionClient, "take_feedback", partial(self._on_taken, "feedback"))
        c.Subscription.take_message = lambda handle, kind, raw: self._take_message(handle, kind, raw)
        ActionClient.is_ready = _is_ready_except_for_status

    # Called after an object was created.

    def _on_new_publisher(self, publisher: Any, *_: Any, **__: Any) -> None:
        if publisher.topic_name not in NOT_COUNTED:
            channel = channels.publisher_channel(publisher.topic_name, publisher.msg_type, publisher.qos_profile)
            depth = (publisher.qos_profile.depth or 1) if channels.is_transient_local(channel) else 0
            self._publisher_channels[(publisher.handle.pointer, "")] = channel, depth
            self.changed = True

    def _on_new_subscription(self, subscription: Any, *_: Any, **__: Any) -> None:
        if subscription.topic_name in NOT_COUNTED:
            self.unpredictable = True
        else:
            qos = subscription.qos_profile
            names = channels.subscription_channels(subscription.topic_name, subscription.msg_type, qos)
            transient_local = qos.durability.name == "TRANSIENT_LOCAL"
            self.counts.add(
                subscription.handle, Reader(subscription, names, depth=qos.depth or 1, transient_local=transient_local)
            )
            self.changed = True

    def _on_new_client(self, client: Any, *_: Any, **__: Any) -> None:
        self._add_client(client, client.handle, "", 0, client.service_name, client.srv_type)

    def _on_new_service(self, service: Any, *_: Any, **__: Any) -> None:
        self._add_service(service, service.handle, "", 0, service.service_name, service.srv_type)

    # The parameters have rclpy's names, because a program may pass them by name.
    def _on_new_action_server(
        self, server: Any, node: Any, action_type: Any, action_name: str, *_: Any, **options: Any
    ) -> None:
        for index, (part, (service, interface)) in enumerate(_PARTS.items()):
            resolved = node.resolve_service_name(f"{action_name}/_action/{service}")
            self._add_service(server, server._handle, part, index, resolved, getattr(action_type.Impl, interface))
        for part, interface, qos in (
            ("feedback", action_type.Impl.FeedbackMessage, options.get("feedback_pub_qos_profile", _FEEDBACK)),
            (
                "status",
                action_type.Impl.GoalStatusMessage,
                options.get("status_pub_qos_profile", qos_profile_action_status_default),
            ),
        ):
            topic = node.resolve_topic_name(f"{action_name}/_action/{part}")
            self._publisher_channels[(server._handle.pointer, part)] = (
                channels.publisher_channel(topic, interface, qos),
                0,
            )
        server.lockstep_requests = self._requests(server._handle)
        server.lockstep_feedback = self._publisher_channels[(server._handle.pointer, "feedback")][0]

    def _on_new_action_client(
        self, client: Any, node: Any, action_type: Any, action_name: str, *_: Any, **options: Any
    ) -> None:
        for index, (part, (service, interface)) in enumerate(_PARTS.items()):
            resolved = node.resolve_service_name(f"{action_name}/_action/{service}")
            self._add_client(
                client, client._client_handle, part, 2 + index, resolved, getattr(action_type.Impl, interface)
            )
        topic = node.resolve_topic_name(f"{action_name}/_action/feedback")
        qos = options.get("feedback_sub_qos_profile", _FEEDBACK)
        names = channels.subscription_channels(topic, action_type.Impl.FeedbackMessage, qos)
        self.counts.add(client._client_handle, Reader(client, names, part=("feedback", 0), depth=qos.depth or 1))
        client.lockstep_requests = self._requests(client._client_handle)
        client.lockstep_feedback = names

    def _on_new_timer(self, timer: Any, *_: Any, **__: Any) -> None:
        self.changed = True
        if timer.clock.clock_type != ClockType.ROS_TIME:
            self._note("clock")

    def _on_new_jump_callback(self, *_: Any, **__: Any) -> None:
        self.unpredictable = True  # it is called whenever the time changes

    def _on_new_waitable(self, node: Any, waitable: Any, **_: Any) -> None:
        self.unpredictable |= not is_predictable(waitable)

    def _requests(self, handle: Any) -> list[str]:
        return [channels.request(*self._services[(handle.pointer, part)]) for part in _PARTS]

    def _add_client(self, entity: Any, handle: Any, part: str, index: int, name: str, kind: Any) -> None:
        self._services[(handle.pointer, part)] = name, kind
        self.counts.add(handle, Reader(entity, (channels.response(name, kind, channels.OWN),), part=(part, index)))
        self.changed = True

    def _add_service(self, entity: Any, handle: Any, part: str, index: int, name: str, kind: Any) -> None:
        self._services[(handle.pointer, part)] = name, kind
        self.counts.add(handle, Reader(entity, (channels.request(name, kind),), part=(part, index)))
        self.changed = True

    # Called after a message was sent.

    def _on_published(self, part: str, handle: Any, *_: Any, result: Any) -> None:
        channel_and_depth = self._publisher_channels.get((handle.pointer, part))
        if channel_and_depth is not None:
            self._count_sent(*channel_and_depth)

    def _on_request_sent(self, part: str, handle: Any, *_: Any, result: Any) -> None:
        self._count_sent(channels.request(*self._services[(handle.pointer, part)]))

    def _on_response_sent(self, part: str, index: int, handle: Any, *arguments: Any, result: Any) -> None:
        name, kind = self._services[(handle.pointer, part)]
        self._count_sent(channels.response(name, kind, channels.client_prefix(arguments[index])))

    def _count_sent(self, channel: str, depth: int = 0) -> None:
        thread = threading.current_thread()
        if thread is not threading.main_thread() and not isinstance(thread, Worker):
            self._note("thread")
        self.counts.count_sent(channel, depth)

    # Called after a message was taken.

    def _on_taken(self, part: str, handle: Any, *_: Any, result: Any) -> None:
        if result is not None and not (isinstance(result, tuple) and any(value is None for value in result)):
            self.counts.count_taken(handle, part)

    def _take_message(self, handle: Any, kind: Any, raw: bool) -> Any:
        message = _take_message(handle, kind, raw)
        if message is None:
            return None
        reader = self.counts.readers.get((handle.pointer, ""))
        if reader is not None and not reader.transient_local and message[1]["source_timestamp"] < reader.matched_ns:
            return None  # sent before the reader was matched, so its arrival depends on chance
        self.counts.count_taken(handle, "")
        return message


def _is_ready_except_for_status(client: Any, wait_set: Any) -> bool:
    """Return whether a client is ready, but take a goal's new status at once.

    The status has a queue of one message, so the number of messages that arrive depends on chance.
    """
    ready = bool(_is_ready(client, wait_set))
    has_response = (
        client._is_goal_response_ready or client._is_cancel_response_ready or client._is_result_response_ready
    )
    if ready and not has_response and not client._is_feedback_ready:
        execution = client.execute(client.take_data())
        try:
            execution.send(None)
        except StopIteration:
            return False
    return ready


def _after(kind: Any, method: str, callback: Callable[..., None]) -> None:
    """Call `callback` after each call of a method, with the call's arguments and its result."""
    original = getattr(kind, method)

    def call(self: Any, *arguments: Any, **options: Any) -> Any:
        result = original(self, *arguments, **options)
        callback(self, *arguments, **options, result=result)
        return result

    setattr(kind, method, call)
