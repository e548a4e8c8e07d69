"""The action that runs a node with a life cycle."""

from __future__ import annotations

import threading
from typing import Any

from launch import LaunchContext, SomeSubstitutionsType
from launch.actions import OpaqueFunction
from launch.event_handler import EventHandler
from launch.logging import get_logger

from ..events.lifecycle import ChangeState, StateTransition
from ..ros_adapters import get_ros_node
from .node import Node

_SHUTDOWN_CHECK_SECONDS = 1.0


class LifecycleNode(Node):
    """Runs a node with a life cycle; the other arguments are those of `Node`.

    A `StateTransition` event tells that the node has changed its state. A `ChangeState` event whose matcher accepts
    this action asks the node to change it.
    """

    def __init__(self, *, name: SomeSubstitutionsType, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self._change_state: Any = None
        self._transition_events: Any = None

    def before_start(self, context: LaunchContext) -> None:
        """Listen to the node's transitions, and register the handler that asks for transitions."""
        if self.UNSPECIFIED_NODE_NAME in self.node_name:
            raise RuntimeError("node_name unexpectedly incomplete for lifecycle node")
        # Not before, as a launched program that is a fork must not find these imported.
        from lifecycle_msgs.msg import TransitionEvent
        from lifecycle_msgs.srv import ChangeState as ChangeStateService

        node = get_ros_node(context)
        self._transition_events = node.create_subscription(
            TransitionEvent, f"{self.node_name}/transition_event", lambda message: self._tell(context, message), 10
        )
        self._change_state = node.create_client(ChangeStateService, f"{self.node_name}/change_state")
        context.register_event_handler(
            EventHandler(
                matcher=lambda event: isinstance(event, ChangeState),
                entities=[OpaqueFunction(function=self._start_change)],
            )
        )

    def _tell(self, context: LaunchContext, message: Any) -> None:
        loop = context.asyncio_loop
        if loop is not None:
            loop.call_soon_threadsafe(context.emit_event_sync, StateTransition(action=self, msg=message))

    def _start_change(self, context: LaunchContext) -> None:
        event: ChangeState = context.locals.event
        if event.lifecycle_node_matcher(self) and context.asyncio_loop is not None:
            change = context.asyncio_loop.run_in_executor(None, self._change, context, event.transition_id)
            context.add_completion_future(change)

    def _change(self, context: LaunchContext, transition_id: int) -> None:
        """Ask the node for a transition and wait for its answer; runs in a thread of its own."""
        logger, service = get_logger(__name__), self._change_state.srv_name
        while not self._change_state.wait_for_service(timeout_sec=_SHUTDOWN_CHECK_SECONDS):
            if context.is_shutdown:
                logger.warning("Abandoning wait for the '%s' service, due to shutdown.", service)
                return
        request = self._change_state.srv_type.Request()
        request.transition.id = transition_id
        answered = threading.Event()
        answer = self._change_state.call_async(request)
        answer.add_done_callback(lambda _: answered.set())
        while not answered.wait(_SHUTDOWN_CHECK_SECONDS):
            if context.is_shutdown:
                logger.warning("Abandoning wait for the '%s' service response, due to shutdown.", service)
                answer.cancel()
                return
        if not answer.result().success:
            transition = ChangeState.valid_transitions[transition_id]
            logger.error("Failed to make transition '%s' for LifecycleNode '%s'", transition, self.node_name)
