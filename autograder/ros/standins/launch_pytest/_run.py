"""One launch during tests: its event loop, and test functions that run beside it."""

from __future__ import annotations

import asyncio
import functools
import inspect
from collections.abc import Callable, Generator, Iterable, Sequence
from typing import Any

from launch import LaunchDescription, LaunchDescriptionEntity, LaunchService
from launch_testing.actions import ReadyToTest


class LaunchRun:
    """A launch description that is launched now and shut down by `end`."""

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
        """Run the loop until the test may begin, or until the launch has ended before."""
        beginning = self.loop.create_task(ready.wait())
        either: list[asyncio.Future[Any]] = [beginning, self._task]
        self.loop.run_until_complete(asyncio.wait(either, return_when=asyncio.FIRST_COMPLETED))
        beginning.cancel()
        if not ready.is_set() and (self._task.cancelled() or self._task.result() != 0):
            self.close()
            raise RuntimeError("the launch has failed before the test could begin: see its output")

    def end(self) -> int:
        """Shut the launch down, or wait for its end; return its return code, the same one each time."""
        if self.loop.is_closed():
            return self._task.result()
        if not self._task.done() and self._auto_shutdown:
            self.service.shutdown(force_sync=True)
        return self.loop.run_until_complete(self._task)

    def close(self) -> None:
        """Close the loop; nothing runs in it after `end`."""
        self.loop.run_until_complete(self.loop.shutdown_default_executor())
        self.loop.close()

    def call(self, function: Callable[..., Any], arguments: dict[str, Any]) -> None:
        """Call a test function beside the launch; what it has after its ``yield`` runs after the end."""
        if inspect.iscoroutinefunction(function):
            self.loop.run_until_complete(function(**arguments))
        elif inspect.isasyncgenfunction(function):
            self._call_in_parts(function(**arguments).__anext__)
        elif inspect.isgeneratorfunction(function):
            self._call_in_parts(functools.partial(self._next_in_thread, function(**arguments)))
        else:
            self.loop.run_until_complete(self._in_thread(functools.partial(function, **arguments)))

    def _call_in_parts(self, advance: Callable[[], Any]) -> None:
        self.loop.run_until_complete(_swallow_end(advance()))
        code = self.end()
        assert code == 0, f"the launch failed: return code {code}"
        if not self.loop.run_until_complete(_swallow_end(advance())):
            raise RuntimeError("a launch test must not have more than one yield")

    def _in_thread(self, function: Callable[[], Any]) -> asyncio.Future[Any]:
        return self.loop.run_in_executor(None, function)

    async def _next_in_thread(self, generator: Generator[Any, None, None]) -> None:
        # A StopIteration cannot cross a future.
        if await self._in_thread(functools.partial(next, generator, generator)) is generator:
            raise StopAsyncIteration


async def _swallow_end(step: Any) -> bool:
    """Await one step of a test; return whether it was the last one."""
    try:
        await step
    except StopAsyncIteration:
        return True
    return False


def _ready_action(description: LaunchDescription) -> ReadyToTest:
    """Return the description's only ReadyToTest, which is added at its end if there is none."""
    found = list(_search(description.entities))
    if len(found) > 1:
        raise RuntimeError(
            "launch_pytest fixtures must return a LaunchDescription containing only one ReadyToTest action"
        )
    if not found:
        found.append(ReadyToTest())
        description.add_action(found[0])
    return found[0]


def _search(entities: Iterable[LaunchDescriptionEntity]) -> Iterable[ReadyToTest]:
    for entity in entities:
        if isinstance(entity, ReadyToTest):
            yield entity
        yield from _search(entity.describe_sub_entities())
        for _, possible in entity.describe_conditional_sub_entities():
            yield from _search(possible)


def launch_description_of(value: Any, fixture_name: str) -> LaunchDescription:
    """Return the launch description that a fixture's value is or begins with; TypeError without one."""
    first = value[0] if isinstance(value, Sequence) and value else value
    if not isinstance(first, LaunchDescription):
        raise TypeError(
            f"When running launch_pytest fixture '{fixture_name}': return value must be either a launch "
            f"description or a sequence which first item is a launch description, got {type(value).__name__}"
        )
    return first
