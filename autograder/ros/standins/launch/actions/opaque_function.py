"""Actions that call Python code: a function, or a coroutine that runs concurrently with the launch."""

from __future__ import annotations

import asyncio
import inspect
from collections.abc import Callable, Coroutine, Iterable, Mapping
from typing import Any

from .._launch_event_handlers import OnShutdown
from ..action import Action, running_loop
from ..event import Event
from ..launch_context import LaunchContext
from ..launch_description_entity import OptionalEntities


class OpaqueFunction(Action):
    """Calls a function with the context; it may return entities to execute next."""

    def __init__(
        self,
        *,
        function: Callable[..., OptionalEntities],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not callable(function):
            raise TypeError(f"OpaqueFunction expected a callable for 'function', got '{type(function)}'")
        self._function = function
        self._args = tuple(args or ())
        self._kwargs = dict(kwargs or {})

    def execute(self, context: LaunchContext) -> OptionalEntities:
        """Call the function."""
        return self._function(context, *self._args, **self._kwargs)


class OpaqueCoroutine(Action):
    """Runs a coroutine function, with the context unless `ignore_context` is set; the end of the launch cancels it."""

    def __init__(
        self,
        *,
        coroutine: Callable[..., Coroutine[Any, Any, Any]],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not inspect.iscoroutinefunction(coroutine):
            raise TypeError(f"OpaqueCoroutine expected a coroutine function for 'coroutine', got '{type(coroutine)}'")
        self._coroutine = coroutine
        self._args = tuple(args or ())
        self._kwargs = dict(kwargs or {})
        self._ignore_context = ignore_context
        self._task: asyncio.Future[None] | None = None

    def execute(self, context: LaunchContext) -> None:
        """Start the coroutine, unless the launch is already shutting down."""
        if context.is_shutdown:
            return
        arguments = self._args if self._ignore_context else (context, *self._args)
        task = running_loop(context).create_task(self._coroutine(*arguments, **self._kwargs))

        def cancel(event: Event, context: LaunchContext) -> None:
            task.cancel()

        context.register_event_handler(OnShutdown(on_shutdown=cancel))
        self._task = task

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return the future that completes when the coroutine does."""
        return self._task
