"""The tests of a file with ``generate_test_description``: one set of them for each launch."""

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
    """One launch, with the tests beside it and those after its end.

    Attributes:
        name: of the file.
        describe: returns the launch description, or a tuple of it and of what tests may ask for.
        parameters: what `parametrize` gives this launch.
        beside: the tests that run while it is launched.
        after: those that run after its end.
        given: what tests get as arguments, by name; filled when the launch is made.
    """

    __test__ = False  # for pytest

    name: str
    describe: Callable[[], Any]
    parameters: Mapping[str, Any]
    beside: unittest.TestSuite
    after: unittest.TestSuite
    given: dict[str, Any] = field(default_factory=dict)

    @property
    def keep_alive(self) -> bool:
        """Whether the launch goes on when nothing is left to do."""
        return bool(getattr(self.describe, "__markers__", {}).get("keep_alive", False))

    @property
    def timeout(self) -> float:
        """The seconds until the tests have to begin."""
        return float(getattr(self.describe, "__ready_to_test_action_timeout__", READY_SECONDS))

    @property
    def cases(self) -> list[unittest.TestCase]:
        """All tests, in their order."""
        return [*_cases(self.beside), *_cases(self.after)]

    def __str__(self) -> str:
        return self.name + _suffix(self.parameters)

    def described(self, ready: Callable[[], None]) -> tuple[LaunchDescription, dict[str, Any]]:
        """Return the launch description, which calls `ready` when the tests may begin, and what tests may ask for.

        Raises:
            Exception: there is no ReadyToTest in it.
        """
        made = self.describe()
        description, context = made if isinstance(made, tuple) else (made, {})
        action = next(_ready_actions(description.entities), None)
        if action is None:
            raise Exception(
                "generate_test_description functions must return a LaunchDescription containing a ReadyToTest action"
            )
        action._add_callback(ready)
        return description, context

    def validate(self) -> None:
        """Raise Exception if `generate_test_description` takes other arguments than `parametrize` gives."""
        taken = inspect.getfullargspec(inspect.unwrap(self.describe))
        names = [*taken.args, *taken.kwonlyargs]
        for name in self.parameters:
            if name not in names:
                raise Exception(
                    f"Could not find an argument in generate_test_description matching prametrized argument '{name}'"
                )
        for name in names:
            if name not in self.parameters:
                raise Exception(f"generate_test_description has unexpected extra argument '{name}'")


def load_tests(module: ModuleType, name: str) -> list[TestRun]:
    """Return the launches of a module with their tests."""
    function = module.generate_test_description
    launches = list(function()) if getattr(function, "__parametrized__", False) else [(function, {})]
    runs = []
    for describe, parameters in launches:
        given: dict[str, Any] = {}
        suites = [_Loader(after, given, _suffix(parameters)).loadTestsFromModule(module) for after in (False, True)]
        runs.append(TestRun(name, describe, parameters, beside=suites[0], after=suites[1], given=given))
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
        for _, possible in entity.describe_conditional_sub_entities():
            yield from _ready_actions(possible)


class _Suite(unittest.TestSuite):
    """Keeps its tests after they ran: reports name them."""

    def _removeTestAtIndex(self, index: int) -> None:
        pass


class _Loader(unittest.TestLoader):
    """Loads the classes of tests beside the launch, or those after its end; their tests get the arguments they name."""

    suiteClass = _Suite

    def __init__(self, after: bool, given: Mapping[str, Any], suffix: str) -> None:
        super().__init__()
        self._after = after
        self._given = given
        self._suffix = suffix

    def loadTestsFromTestCase(self, testCaseClass: type[unittest.TestCase]) -> unittest.TestSuite:
        if getattr(testCaseClass, "__post_shutdown_test__", False) != self._after:
            return self.suiteClass()
        names = self.getTestCaseNames(testCaseClass)
        methods: dict[str, Any] = {
            name + self._suffix: _given_to(getattr(testCaseClass, name), self._given) for name in names
        }
        for name in ("setUp", "tearDown"):
            methods[name] = _given_to(getattr(testCaseClass, name), self._given)
        for name in ("setUpClass", "tearDownClass"):
            function = inspect.getattr_static(testCaseClass, name).__func__
            methods[name] = classmethod(_given_to(function, self._given))
        kind = type(testCaseClass.__name__, (testCaseClass,), {"__module__": testCaseClass.__module__, **methods})
        return self.suiteClass([kind(name + self._suffix) for name in names])


def _given_to(function: Callable[..., Any], given: Mapping[str, Any]) -> Callable[..., Any]:
    """Return a method that calls another one with those of `given` that it has arguments for."""
    wanted = inspect.signature(function).parameters

    def call(self: Any) -> Any:
        return function(self, **{name: value for name, value in given.items() if name in wanted})

    call.__doc__ = function.__doc__
    return call


__getattr__ = make_getattr(__name__)
