"""The tests of a file with ``generate_test_description``, loaded for each of its launches."""

from __future__ import annotations

import inspect
import unittest
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

from launch import LaunchDescription, LaunchDescriptionEntity
from standin_notice import make_getattr

from .actions import ReadyToTest

READY_SECONDS = 15.0


@dataclass(frozen=True)
class TestRun:
    """A launch, with the tests that run during it and after its end.

    Attributes:
        name: the name of the file.
        generate: returns the launch description, or a tuple of it and additional arguments of tests.
        parameters: the arguments of this launch from `parametrize`.
        active_tests: the tests that run during the launch.
        post_shutdown_tests: the tests that run after its end.
        arguments: the arguments that tests can have, by name; set when the launch starts.
    """

    __test__ = False  # for pytest

    name: str
    generate: Callable[[], Any]
    parameters: Mapping[str, Any]
    active_tests: unittest.TestSuite
    post_shutdown_tests: unittest.TestSuite
    arguments: dict[str, Any] = field(default_factory=dict)

    @property
    def keep_alive(self) -> bool:
        """Whether the launch continues when nothing is left to do."""
        return bool(getattr(self.generate, "__markers__", {}).get("keep_alive", False))

    @property
    def timeout(self) -> float:
        """The seconds until the tests have to start."""
        return float(getattr(self.generate, "__ready_to_test_action_timeout__", READY_SECONDS))

    @property
    def cases(self) -> list[unittest.TestCase]:
        """All tests in order."""
        return [*_cases(self.active_tests), *_cases(self.post_shutdown_tests)]

    def __str__(self) -> str:
        return self.name + _suffix(self.parameters)

    def describe(self, ready: Callable[[], None]) -> tuple[LaunchDescription, dict[str, Any]]:
        """Return the launch description, which calls `ready` when the tests may start, and the arguments of tests.

        Raises:
            Exception: the description has no ReadyToTest.
        """
        result = self.generate()
        description, context = result if isinstance(result, tuple) else (result, {})
        action = next(_ready_actions(description.entities), None)
        if action is None:
            raise Exception(
                "generate_test_description functions must return a LaunchDescription containing a ReadyToTest action"
            )
        action._add_callback(ready)
        return description, context

    def validate(self) -> None:
        """Raise Exception unless `parametrize` matches the arguments of `generate_test_description`."""
        spec = inspect.getfullargspec(inspect.unwrap(self.generate))
        names = [*spec.args, *spec.kwonlyargs]
        for name in self.parameters:
            if name not in names:
                raise Exception(
                    f"Could not find an argument in generate_test_description matching prametrized argument '{name}'"
                )
        for name in names:
            if name not in self.parameters:
                raise Exception(f"generate_test_description has unexpected extra argument '{name}'")


def load_tests(module: ModuleType, name: str) -> list[TestRun]:
    """Return the launches of a module, with their tests."""
    function = module.generate_test_description
    launches = list(function()) if getattr(function, "__parametrized__", False) else [(function, {})]
    runs = []
    for generate, parameters in launches:
        arguments: dict[str, Any] = {}
        suites = [
            _Loader(is_post_shutdown, arguments, _suffix(parameters)).loadTestsFromModule(module)
            for is_post_shutdown in (False, True)
        ]
        runs.append(
            TestRun(
                name, generate, parameters, active_tests=suites[0], post_shutdown_tests=suites[1], arguments=arguments
            )
        )
    return runs


def _suffix(parameters: Mapping[str, Any]) -> str:
    return f"[{', '.join(map(str, parameters.values()))}]" if parameters else ""


def _cases(suite: Iterable[Any]) -> Iterator[unittest.TestCase]:
    for test in suite:
        if isinstance(test, unittest.TestSuite):
            yield from _cases(test)
        elif test is not None:
            yield test


def _ready_actions(entities: Iterable[LaunchDescriptionEntity]) -> Iterator[ReadyToTest]:
    for entity in entities:
        if isinstance(entity, ReadyToTest):
            yield entity
        yield from _ready_actions(entity.describe_sub_entities())
        for _, sub_entities in entity.describe_conditional_sub_entities():
            yield from _ready_actions(sub_entities)


class _Suite(unittest.TestSuite):
    """Keeps its tests after they ran, because reports name them."""

    def _removeTestAtIndex(self, index: int) -> None:
        pass


class _Loader(unittest.TestLoader):
    """Loads the test classes for the time during the launch, or after it; tests get the arguments that they have."""

    suiteClass = _Suite

    def __init__(self, is_post_shutdown: bool, arguments: Mapping[str, Any], suffix: str) -> None:
        super().__init__()
        self._is_post_shutdown = is_post_shutdown
        self._arguments = arguments
        self._suffix = suffix

    def loadTestsFromTestCase(self, testCaseClass: type[unittest.TestCase]) -> unittest.TestSuite:
        if getattr(testCaseClass, "__post_shutdown_test__", False) != self._is_post_shutdown:
            return self.suiteClass()
        names = self.getTestCaseNames(testCaseClass)
        methods: dict[str, Any] = {
            name + self._suffix: _with_arguments(getattr(testCaseClass, name), self._arguments) for name in names
        }
        for name in ("setUp", "tearDown"):
            methods[name] = _with_arguments(getattr(testCaseClass, name), self._arguments)
        for name in ("setUpClass", "tearDownClass"):
            function = inspect.getattr_static(testCaseClass, name).__func__
            methods[name] = classmethod(_with_arguments(function, self._arguments))
        test_class = type(testCaseClass.__name__, (testCaseClass,), {"__module__": testCaseClass.__module__, **methods})
        return self.suiteClass([test_class(name + self._suffix) for name in names])


def _with_arguments(function: Callable[..., Any], arguments: Mapping[str, Any]) -> Callable[..., Any]:
    """Return a method that calls `function` with those of `arguments` that it has parameters for."""
    parameters = inspect.signature(function).parameters

    def call(self: Any) -> Any:
        return function(self, **{name: value for name, value in arguments.items() if name in parameters})

    call.__doc__ = function.__doc__
    return call


__getattr__ = make_getattr(__name__)
