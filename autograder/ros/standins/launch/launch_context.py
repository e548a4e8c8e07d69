"""The context: the state of a running launch, such as its configurations, environment and event handlers."""

from __future__ import annotations

import asyncio
import os
from collections import deque
from collections.abc import Coroutine, Iterable, MutableMapping
from typing import Any, Protocol

from .event import Event


class Handler(Protocol):
    """The part of an event handler that the context uses; `launch.event_handler.BaseEventHandler` is one."""

    def matches(self, event: Event) -> bool:
        """Return whether this handler matches `event`."""

    def handle(self, event: Event, context: LaunchContext) -> Any:
        """Handle `event`; return entities to visit next, or None."""


class Performable(Protocol):
    """The part of a substitution that the context uses; `launch.Substitution` is one."""

    def perform(self, context: LaunchContext) -> str:
        """Return the text of this substitution in `context`."""


class _Locals:
    """Attribute access to the innermost local values."""

    def __init__(self, values: dict[str, Any]) -> None:
        self._values = values

    def __getattr__(self, name: str) -> Any:
        try:
            return self._values[name]
        except KeyError:
            raise AttributeError(f"context.locals has no variable '{name}'") from None


class LaunchContext:
    """The state of a launch while a launch description is executed.

    Launch configurations are a dictionary of strings that groups save and restore. The environment is that of the
    process, as in the real package, so that launch files see it in ``os.environ``.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.argv = list(argv) if argv is not None else []
        self.noninteractive = noninteractive
        self.launch_configurations: dict[str, Any] = {}
        self.asyncio_loop: asyncio.AbstractEventLoop | None = None
        self.is_shutdown = False
        self._initial_environment = dict(os.environ)
        self._configuration_stack: list[dict[str, Any]] = []
        self._environment_stack: list[dict[str, str]] = []
        self._locals_stack: list[dict[str, Any]] = []
        self._locals: dict[str, Any] = {}
        self._globals: dict[str, Any] = {}
        self._event_handlers: deque[Handler] = deque()
        self._event_queue: asyncio.Queue[Event] = asyncio.Queue()
        self._completion_futures: list[asyncio.Future[None]] = []
        self._tasks: set[asyncio.Task[None]] = set()

    @property
    def environment(self) -> MutableMapping[str, str]:
        """The environment that substitutions read and processes inherit."""
        return os.environ

    @property
    def locals(self) -> _Locals:
        """The local values, e.g. ``context.locals.event`` while an event is handled."""
        return _Locals(self.get_locals_as_dict())

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        """Add `extensions` to the local values permanently; inner values of the same names hide them."""
        self._globals.update(extensions)

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        """Add `extensions` to the innermost local values."""
        self._locals.update(extensions)

    def get_locals_as_dict(self) -> dict[str, Any]:
        """Return the local values."""
        return {**self._globals, **self._locals}

    def _push_locals(self) -> None:
        self._locals_stack.append(dict(self._locals))

    def _pop_locals(self) -> None:
        self._locals = self._pop(self._locals_stack, "locals")

    def _push_launch_configurations(self) -> None:
        self._configuration_stack.append(dict(self.launch_configurations))

    def _pop_launch_configurations(self) -> None:
        # Changes the dictionary in place, because callers may keep a reference to it.
        saved = self._pop(self._configuration_stack, "launch configurations")
        self.launch_configurations.clear()
        self.launch_configurations.update(saved)

    def _push_environment(self) -> None:
        self._environment_stack.append(dict(os.environ))

    def _pop_environment(self) -> None:
        self._replace_environment(self._pop(self._environment_stack, "environment"))

    def _reset_environment(self) -> None:
        self._replace_environment(self._initial_environment)

    @staticmethod
    def _pop(stack: list[dict[str, Any]], name: str) -> dict[str, Any]:
        if not stack:
            raise RuntimeError(f"{name} stack unexpectedly empty")
        return stack.pop()

    @staticmethod
    def _replace_environment(values: dict[str, str]) -> None:
        os.environ.clear()
        os.environ.update(values)

    def register_event_handler(self, event_handler: Handler, append: bool = False) -> None:
        """Register `event_handler` before the others, or after them with `append`."""
        if append:
            self._event_handlers.append(event_handler)
        else:
            self._event_handlers.appendleft(event_handler)

    def unregister_event_handler(self, event_handler: Handler) -> None:
        """Remove `event_handler`; ValueError if it is not registered."""
        self._event_handlers.remove(event_handler)

    def would_handle_event(self, event: Event) -> bool:
        """Return whether a registered handler matches `event`."""
        return any(handler.matches(event) for handler in tuple(self._event_handlers))

    def add_completion_future(self, completion_future: asyncio.Future[None]) -> None:
        """Keep the launch running until `completion_future` is done."""
        self._completion_futures.append(completion_future)

    def start_task(self, coroutine: Coroutine[Any, Any, None]) -> None:
        """Run `coroutine` concurrently with the launch, which cancels it if the launch is aborted."""
        if self.asyncio_loop is None:
            raise RuntimeError("the launch context is used outside of a running LaunchService")
        task = self.asyncio_loop.create_task(coroutine)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def emit_event_sync(self, event: Event) -> None:
        """Queue `event`; must be called from the launch's own thread."""
        self._event_queue.put_nowait(event)

    async def emit_event(self, event: Event) -> None:
        """Queue `event`."""
        self._event_queue.put_nowait(event)

    def perform_substitution(self, sub: Performable) -> str:
        """Return the text of `sub` in this context."""
        return sub.perform(self)
