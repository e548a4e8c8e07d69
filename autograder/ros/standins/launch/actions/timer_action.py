"""The action that executes others after some time."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import Any

from .._launch_event_handlers import OnShutdown
from ..action import Action, running_loop
from ..conditions import evaluate_condition_expression
from ..event import Event
from ..event_handler import EventHandler
from ..events import TimerEvent
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity, OptionalEntities
from ..substitution import (
    SomeSubstitutionsType,
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from .opaque_function import OpaqueFunction


class TimerAction(Action):
    """Executes `actions` once, `period` seconds after this action was executed, unless it is cancelled."""

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.period = normalize_to_list_of_substitutions(str(period) if isinstance(period, (int, float)) else period)
        self.actions = list(actions)
        self._cancel_on_shutdown = cancel_on_shutdown
        self._canceled = False
        self._cancel_requested: asyncio.Future[None] | None = None
        self._completion: asyncio.Future[None] | None = None
        self._locals: dict[str, Any] = {}

    def describe(self) -> str:
        """Return a description with the period."""
        return f"{type(self).__name__}(period={describe_substitutions(self.period)}, actions=<actions>)"

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the actions that are executed after the period."""
        period = describe_substitutions(self.period)
        return [(f"{period} seconds pass without being canceled", self.actions)]

    def cancel(self) -> None:
        """Cancel the timer; this has no effect once the actions were executed."""
        self._canceled = True
        if self._cancel_requested is not None and not self._cancel_requested.done():
            self._cancel_requested.set_result(None)

    def execute(self, context: LaunchContext) -> None:
        """Start the timer."""
        loop = running_loop(context)
        self._completion = loop.create_future()
        self._cancel_requested = loop.create_future()
        ends_with_launch = self._cancels_on_shutdown(context)
        if self._canceled or (ends_with_launch and context.is_shutdown):
            self._completion.set_result(None)
            return
        self._locals = dict(context.get_locals_as_dict())
        if ends_with_launch:
            context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: self.cancel()))
        context.register_event_handler(
            EventHandler(
                matcher=self._matches, entities=OpaqueFunction(function=self._actions_on_timer), handle_once=True
            )
        )
        seconds = float(perform_substitutions(context, self.period))
        context.start_task(self._wait(context, seconds))

    def _cancels_on_shutdown(self, context: LaunchContext) -> bool:
        if isinstance(self._cancel_on_shutdown, bool):
            return self._cancel_on_shutdown
        return evaluate_condition_expression(context, normalize_to_list_of_substitutions(self._cancel_on_shutdown))

    async def _wait(self, context: LaunchContext, seconds: float) -> None:
        assert self._cancel_requested is not None
        assert self._completion is not None
        await self._sleep(context, seconds, self._cancel_requested)
        if not self._cancel_requested.done():
            context.emit_event_sync(TimerEvent(timer_action=self))
        self._completion.set_result(None)

    async def _sleep(self, context: LaunchContext, seconds: float, cancel: asyncio.Future[None]) -> None:
        """Wait for `seconds` of wall time, or until `cancel` completes."""
        await asyncio.wait([cancel], timeout=seconds)

    def _matches(self, event: Event) -> bool:
        return isinstance(event, TimerEvent) and event.timer_action is self

    def _actions_on_timer(self, context: LaunchContext) -> OptionalEntities:
        context.extend_locals(self._locals)
        return self.actions

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return the future that completes when the timer has fired or was cancelled."""
        return self._completion
