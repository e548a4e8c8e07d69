"""The event handlers of launch files: for processes, for actions that complete, and for the end of the launch."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from standin_notice import make_getattr

from ._launch_event_handlers import OnExecutionComplete, OnIncludeLaunchDescription, OnShutdown
from .action import Action
from .actions.execute_local import ExecuteLocal
from .event import Event
from .event_handler import ActionMatcher, EventCallback, OnActionEventBase
from .events.process import ProcessExited, ProcessIO, ProcessStarted
from .launch_context import LaunchContext
from .launch_description_entity import OptionalEntities, SomeEntitiesType

__all__ = [
    "OnExecutionComplete",
    "OnIncludeLaunchDescription",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
]


class OnProcessStart(OnActionEventBase):
    """Handle the start of a process."""

    def __init__(
        self,
        *,
        target_action: Action | ActionMatcher | None = None,
        on_start: SomeEntitiesType | EventCallback,
        handle_once: bool = False,
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            target_action_cls=ExecuteLocal,
            handle_once=handle_once,
        )


class OnProcessExit(OnActionEventBase):
    """Handle the exit of a process."""

    def __init__(
        self,
        *,
        target_action: Action | ActionMatcher | None = None,
        on_exit: SomeEntitiesType | EventCallback,
        handle_once: bool = False,
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_exit,
            target_event_cls=ProcessExited,
            target_action_cls=ExecuteLocal,
            handle_once=handle_once,
        )


IOCallback = Callable[[Any], OptionalEntities]


class OnProcessIO(OnActionEventBase):
    """Handle the output of a process as it comes; each callable gets only the event."""

    def __init__(
        self,
        *,
        target_action: Action | ActionMatcher | None = None,
        on_stdin: IOCallback | None = None,
        on_stdout: IOCallback | None = None,
        on_stderr: IOCallback | None = None,
        handle_once: bool = False,
    ) -> None:
        def dispatch(event: Event, context: LaunchContext) -> OptionalEntities:
            io = cast(ProcessIO, event)
            for is_from_stream, callback in (
                (io.from_stdout, on_stdout),
                (io.from_stderr, on_stderr),
                (io.from_stdin, on_stdin),
            ):
                if is_from_stream and callback is not None:
                    return callback(io)
            return None

        super().__init__(
            action_matcher=target_action,
            on_event=dispatch,
            target_event_cls=ProcessIO,
            target_action_cls=ExecuteLocal,
            handle_once=handle_once,
        )


__getattr__ = make_getattr(__name__)
