"""The event handlers of launch files: processes start, write and exit; actions complete; the launch ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from standin_notice import guard

from .action import Action
from .event import Event
from .event_handler import (
    ActionMatcher,
    BaseEventHandler,
    EventCallback,
    OnActionEventBase,
    split_callback,
)
from .events import ExecutionComplete, IncludeLaunchDescription, Shutdown
from .events.process import ProcessExited, ProcessIO, ProcessStarted
from .launch_context import LaunchContext
from .launch_description_entity import LaunchDescriptionEntity, OptionalEntities, SomeEntitiesType

__all__ = [
    "OnExecutionComplete",
    "OnIncludeLaunchDescription",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
]


def _process_action() -> type[Action]:
    from .actions.execute_local import ExecuteLocal

    return ExecuteLocal


class OnExecutionComplete(OnActionEventBase):
    """Handle the completion of an action."""

    def __init__(
        self,
        *,
        target_action: Action | ActionMatcher | None = None,
        on_completion: SomeEntitiesType | EventCallback,
        handle_once: bool = False,
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_completion,
            target_event_cls=ExecutionComplete,
            target_action_cls=Action,
            handle_once=handle_once,
        )


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
            target_action_cls=_process_action(),
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
            target_action_cls=_process_action(),
            handle_once=handle_once,
        )


IOCallback = Callable[[Any], OptionalEntities]


class OnProcessIO(OnActionEventBase):
    """Handle the output of a process, bytes as they come; each callable gets the event alone."""

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
            for wanted, callback in (
                (io.from_stdout, on_stdout),
                (io.from_stderr, on_stderr),
                (io.from_stdin, on_stdin),
            ):
                if wanted and callback is not None:
                    return callback(io)
            return None

        super().__init__(
            action_matcher=target_action,
            on_event=dispatch,
            target_event_cls=ProcessIO,
            target_action_cls=_process_action(),
            handle_once=handle_once,
        )


class OnShutdown(BaseEventHandler):
    """Handle the end of the launch."""

    def __init__(self, *, on_shutdown: SomeEntitiesType | EventCallback, handle_once: bool = False) -> None:
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), handle_once=handle_once)
        self._callback, self._entities = split_callback(on_shutdown)

    @property
    def matcher_description(self) -> str:
        """Which events it handles, in words."""
        return "event is Shutdown"

    @property
    def handler_description(self) -> str:
        """What the handler does, in words."""
        return f"{self._callback}" if self._callback else "<actions>"

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description, and the entities that are known beforehand."""
        return super().describe()[0], list(self._entities)

    def handle(self, event: Event, context: LaunchContext) -> OptionalEntities:
        """Return the entities, or what the callable returns."""
        super().handle(event, context)
        return self._callback(event, context) if self._callback else self._entities


class OnIncludeLaunchDescription(BaseEventHandler):
    """Execute the launch description that an event brings."""

    def __init__(self) -> None:
        super().__init__(matcher=lambda event: isinstance(event, IncludeLaunchDescription))

    def handle(self, event: Event, context: LaunchContext) -> OptionalEntities:
        """Return the launch description."""
        super().handle(event, context)
        return cast(IncludeLaunchDescription, event).launch_description


__getattr__ = guard(__name__)
