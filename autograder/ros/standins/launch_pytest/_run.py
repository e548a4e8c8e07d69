"""A launch during tests, with its event loop and the test functions that run in it."""

from __future__ import annotations

import asyncio
import functools
import inspect
from collections.abc import Callable, Generator, Iterable, Sequence
from typing import Any

from launch import LaunchDescription, LaunchDescriptionEntity, LaunchService
from launch_testing.actions import ReadyToTest


class LaunchRun:
    """A running launch of a launch description, which `end` shuts down."""

    def __init__(self, description: LaunchDescription, *, shutdown_when_idle: bool, auto_shutdown: bool) -> None:
        self.loop = asyncio.new_event_loop()
        self.service = LaunchService()
        self._auto_shutdown = auto_shutdown
        self.service.include_launch_description(description)
        ready = asyncio.Event()
        _ready_action(description)._add_callback(ready.set)
        self._task = self.loop.create_task(self.service.run_async(shutdown_when_idle=shutdown_when_idle))
        self._wait_until(ready)

    def _wait_until(self, ready: asyncio.Event) -> None:
        """Run the loop until the test may start, or the launch has ended."""
        ready_task = self.loop.create_task(ready.wait())
        ready_or_end: list[asyncio.Future[Any]] = [ready_task, self._task]
        self.loop.run_until_complete(asyncio.wait(ready_or_end, return_when=asyncio.FIRST_COMPLETED))
        ready_task.cancel()
        if not ready.is_set() and (self._task.cancelled() or self._task.result() != 0):
            self.close()
            raise RuntimeError("the launch has failed before the test could begin: see its output")

    def end(self) -> int:
        """Shut the launch down, or wait for its end; return its return code, also on later calls."""
        if self.loop.is_closed():
            return self._task.result()
        if not self._task.done() and self._auto_shutdown:
            self.service.shutdown(force_sync=True)
        return self.loop.run_until_complete(self._task)

    def close(self) -> None:
        """Close the loop, in which nothing runs after `end`."""
        self.loop.run_until_complete(self.loop.shutdown_default_executor())
        self.loop.close()

    def call(self, function: Callable[..., Any], arguments: dict[str, Any]) -> None:
        """Call a test function during the launch; the code after its ``yield`` runs after the launch."""
        if inspect.iscoroutinefunction(function):
            self.loop.run_until_complete(function(**arguments))
        elif inspect.isasyncgenfunction(function):
            self._call_in_parts(function(**arguments).__anext__)
        elif inspect.isgeneratorfunction(function):
            self._call_in_parts(functools.partial(self._next_in_thread, function(**arguments)))
        else:
            self.loop.run_until_complete(self._in_thread(functools.partial(function, **arguments)))

    def _call_in_parts(self, advance: Callable[[], Any]) -> None:
        self.loop.run_until_complete(_is_last_step(advance()))
        code = self.end()
        assert code == 0, f"the launch failed: return code {code}"
        if not self.loop.run_until_complete(_is_last_step(advance())):
            raise RuntimeError("a launch test must not have more than one yield")

    def _in_thread(self, function: Callable[[], Any]) -> asyncio.Future[Any]:
        return self.loop.run_in_executor(None, function)

    async def _next_in_thread(self, generator: Generator[Any, None, None]) -> None:
        # A future cannot raise StopIteration.
        if await self._in_thread(functools.partial(next, generator, generator)) is generator:
            raise StopAsyncIteration


async def _is_last_step(step: Any) -> bool:
    """Await one step of a test; return whether it was the last one."""
    try:
        await step
    except StopAsyncIteration:
        return True
    return False


def _ready_action(description: LaunchDescription) -> ReadyToTest:
    """Return the description's only ReadyToTest; without one, add it at the end."""
    actions = list(_find_ready_actions(description.entities))
    if len(actions) > 1:
        raise RuntimeError(
            "launch_pytest fixtures must return a LaunchDescription containing only one ReadyToTest action"
        )
    if not actions:
        actions.append(ReadyToTest())
        description.add_action(actions[0])
    return actions[0]


def _find_ready_actions(entities: Iterable[LaunchDescriptionEntity]) -> Iterable[ReadyToTest]:
    for entity in entities:
        if isinstance(entity, ReadyToTest):
            yield entity
        yield from _find_ready_actions(entity.describe_sub_entities())
        for _, sub_entities in entity.describe_conditional_sub_entities():
            yield from _find_ready_actions(sub_entities)


def launch_description_of(value: Any, fixture_name: str) -> LaunchDescription:
    """Return a fixture's value, or its first item, if that is a launch description; raise TypeError if not."""
    first = value[0] if isinstance(value, Sequence) and value else value
    if not isinstance(first, LaunchDescription):
        raise TypeError(
            f"When running launch_pytest fixture '{fixture_name}': return value must be either a launch "
            f"description or a sequence which first item is a launch description, got {type(value).__name__}"
        )
    return first
