"""Decorators for the ``generate_test_description`` and the test cases of a test file."""

from __future__ import annotations

import functools
import inspect
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from standin_notice import make_getattr

__all__ = ["keep_alive", "parametrize", "post_shutdown_test", "ready_to_test_action_timeout", "retry_on_failure"]

Function = TypeVar("Function", bound=Callable[..., Any])
Class = TypeVar("Class", bound=type)


def keep_alive(test_description: Function) -> Function:
    """Let the launch continue when nothing is left to do, until the tests have ended."""
    vars(test_description).setdefault("__markers__", {})["keep_alive"] = True
    return test_description


def ready_to_test_action_timeout(timeout: float) -> Callable[[Function], Function]:
    """Wait up to `timeout` seconds, instead of 15, until the tests may start."""

    def decorate(function: Function) -> Function:
        function.__ready_to_test_action_timeout__ = timeout  # type: ignore[attr-defined]
        return function

    return decorate


def post_shutdown_test() -> Callable[[Class], Class]:
    """Run the tests of a class after the end of the launch; raise TypeError unless it is a class."""

    def decorate(test_case: Class) -> Class:
        if not isinstance(test_case, type):
            raise TypeError("postcondition_test should decorate test classes")
        test_case.__post_shutdown_test__ = True  # type: ignore[attr-defined]
        return test_case

    return decorate


def parametrize(argnames: str, argvalues: Sequence[Any]) -> Callable[[Callable[..., Any]], Callable[[], Any]]:
    """Launch and test once for each of the values.

    Args:
        argnames: the names of the arguments of ``generate_test_description``, separated by commas.
        argvalues: a tuple of values for each launch; a single value is used as a tuple of it.
    """
    names = [name.strip() for name in argnames.split(",") if name.strip()]
    rows = [row if isinstance(row, tuple) else (row,) for row in argvalues]

    def decorate(function: Callable[..., Any]) -> Callable[[], Any]:
        @functools.wraps(function)
        def launches() -> Iterator[tuple[Callable[..., Any], dict[str, Any]]]:
            for row in rows:
                arguments = dict(zip(names, row, strict=False))
                yield functools.update_wrapper(functools.partial(function, **arguments), function), arguments

        launches.__parametrized__ = True  # type: ignore[attr-defined]
        return launches

    return decorate


def retry_on_failure(*, times: int, delay: float | None = None) -> Callable[[Function], Function]:
    """Repeat a test whose assertion fails up to `times` times, with `delay` seconds between."""
    assert times > 0

    def decorate(test: Function) -> Function:
        assert next(iter(inspect.signature(test).parameters)) == "self"

        @functools.wraps(test)
        def retry(self: Any, *args: Any, **kwargs: Any) -> Any:
            for _ in range(times - 1):
                try:
                    return test(self, *args, **kwargs)
                except AssertionError:
                    if delay is not None:
                        time.sleep(delay)
            return test(self, *args, **kwargs)

        return retry  # type: ignore[return-value]

    return decorate


__getattr__ = make_getattr(__name__)
