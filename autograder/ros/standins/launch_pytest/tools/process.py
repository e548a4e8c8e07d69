"""Functions that wait until a process has started, written something or exited.

Those with `_sync` are for plain tests, the others for coroutines. Each returns whether this happened within `timeout`
seconds, and waits forever without one. To wait for output, create the action with ``cached_output=True``. A validator
gets the whole output. For `wait_for`, it returns whether the output is as expected. For `assert`, it raises an
AssertionError while the output is not as expected, and its return value is ignored.
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
from collections.abc import Callable, Iterator

from launch import LaunchContext
from launch.actions import ExecuteLocal
from launch.event_handler import BaseEventHandler
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from standin_notice import make_getattr

Validator = Callable[[str], object]


def _handlers(action: ExecuteLocal, notify: Callable[[], None]) -> list[BaseEventHandler]:
    """Return handlers that call `notify` for each event of the process."""
    return [
        OnProcessStart(target_action=action, on_start=lambda event, context: notify()),
        OnProcessIO(target_action=action, on_stdout=lambda event: notify(), on_stderr=lambda event: notify()),
        OnProcessExit(target_action=action, on_exit=lambda event, context: notify()),
    ]


@contextlib.contextmanager
def _call_on_events(context: LaunchContext, action: ExecuteLocal, notify: Callable[[], None]) -> Iterator[None]:
    handlers = _handlers(action, notify)
    for handler in handlers:
        context.register_event_handler(handler, append=True)
    try:
        yield
    finally:
        for handler in handlers:
            context.unregister_event_handler(handler)


async def _wait(
    context: LaunchContext, action: ExecuteLocal, condition: Callable[[], bool], timeout: float | None
) -> bool:
    changed = asyncio.Event()
    deadline = None if timeout is None else time.monotonic() + timeout
    with _call_on_events(context, action, changed.set):
        while not condition():
            changed.clear()
            remaining = None if deadline is None else deadline - time.monotonic()
            try:
                await asyncio.wait_for(changed.wait(), remaining)
            except asyncio.TimeoutError:
                return condition()
    return True


def _wait_sync(
    context: LaunchContext, action: ExecuteLocal, condition: Callable[[], bool], timeout: float | None
) -> bool:
    changed = threading.Event()
    deadline = None if timeout is None else time.monotonic() + timeout
    with _call_on_events(context, action, changed.set):
        while not condition():
            remaining = None if deadline is None else deadline - time.monotonic()
            if not changed.wait(remaining):
                return condition()
            changed.clear()
    return True


def _has_started(action: ExecuteLocal) -> Callable[[], bool]:
    return lambda: "pid" in (action.process_details or {})


def _has_exited(action: ExecuteLocal) -> Callable[[], bool]:
    return lambda: action.return_code is not None


def _returns_true(read: Callable[[], str], validate: Validator) -> Callable[[], bool]:
    return lambda: bool(validate(read()))


def _raises_no_assertion(read: Callable[[], str], validate: Validator) -> Callable[[], bool]:
    def condition() -> bool:
        try:
            validate(read())
        except AssertionError:
            return False
        return True

    return condition


async def wait_for_start(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> bool:
    """Wait until the process has started."""
    return await _wait(launch_context, execute_process_action, _has_started(execute_process_action), timeout)


def wait_for_start_sync(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> bool:
    """Wait until the process has started."""
    return _wait_sync(launch_context, execute_process_action, _has_started(execute_process_action), timeout)


async def wait_for_exit(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> bool:
    """Wait until the process has exited."""
    return await _wait(launch_context, execute_process_action, _has_exited(execute_process_action), timeout)


def wait_for_exit_sync(
    launch_context: LaunchContext, execute_process_action: ExecuteLocal, timeout: float | None = None
) -> bool:
    """Wait until the process has exited."""
    return _wait_sync(launch_context, execute_process_action, _has_exited(execute_process_action), timeout)


async def wait_for_output(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validator,
    timeout: float | None = None,
) -> bool:
    """Wait until the validator accepts the standard output."""
    condition = _returns_true(execute_process_action.get_stdout, validate_output)
    return await _wait(launch_context, execute_process_action, condition, timeout)


def wait_for_output_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validator,
    timeout: float | None = None,
) -> bool:
    """Wait until the validator accepts the standard output."""
    condition = _returns_true(execute_process_action.get_stdout, validate_output)
    return _wait_sync(launch_context, execute_process_action, condition, timeout)


async def wait_for_stderr(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validator,
    timeout: float | None = None,
) -> bool:
    """Wait until the validator accepts the standard error."""
    condition = _returns_true(execute_process_action.get_stderr, validate_output)
    return await _wait(launch_context, execute_process_action, condition, timeout)


def wait_for_stderr_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validator,
    timeout: float | None = None,
) -> bool:
    """Wait until the validator accepts the standard error."""
    condition = _returns_true(execute_process_action.get_stderr, validate_output)
    return _wait_sync(launch_context, execute_process_action, condition, timeout)


async def assert_output(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validator,
    timeout: float | None = None,
) -> None:
    """Fail unless the validator accepts the standard output in time."""
    condition = _raises_no_assertion(execute_process_action.get_stdout, validate_output)
    if not await _wait(launch_context, execute_process_action, condition, timeout):
        validate_output(execute_process_action.get_stdout())


def assert_output_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validator,
    timeout: float | None = None,
) -> None:
    """Fail unless the validator accepts the standard output in time."""
    condition = _raises_no_assertion(execute_process_action.get_stdout, validate_output)
    if not _wait_sync(launch_context, execute_process_action, condition, timeout):
        validate_output(execute_process_action.get_stdout())


async def assert_stderr(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validator,
    timeout: float | None = None,
) -> None:
    """Fail unless the validator accepts the standard error in time."""
    condition = _raises_no_assertion(execute_process_action.get_stderr, validate_output)
    if not await _wait(launch_context, execute_process_action, condition, timeout):
        validate_output(execute_process_action.get_stderr())


def assert_stderr_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Validator,
    timeout: float | None = None,
) -> None:
    """Fail unless the validator accepts the standard error in time."""
    condition = _raises_no_assertion(execute_process_action.get_stderr, validate_output)
    if not _wait_sync(launch_context, execute_process_action, condition, timeout):
        validate_output(execute_process_action.get_stderr())


__getattr__ = make_getattr(__name__)
