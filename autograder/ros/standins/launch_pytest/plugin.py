"""The pytest plugin, which launches the descriptions of fixtures and runs the marked tests during the launch."""

from __future__ import annotations

import asyncio
import inspect
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from _pytest.fixtures import FixtureDef  # pytest exports it since 8.1
    from launch import LaunchContext, LaunchService

    from ._run import LaunchRun

_RUNS = pytest.StashKey[dict[str, "LaunchRun"]]()


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker."""
    config.addinivalue_line(
        "markers",
        "launch(fixture, shutdown=False): run the test while the launch description of the fixture is launched, "
        "or after its end",
    )
    config.stash[_RUNS] = {}


@pytest.hookimpl(wrapper=True)
def pytest_fixture_setup(fixturedef: FixtureDef[Any], request: pytest.FixtureRequest) -> Any:
    """Launch the description that a launch fixture returns; shut it down when the fixture ends."""
    value = yield
    options = getattr(fixturedef.func, "_launch_pytest_options", None)
    if options is None:
        return value
    from ._run import LaunchRun, launch_description_of

    name = fixturedef.argname
    run = LaunchRun(
        launch_description_of(value, name),
        shutdown_when_idle=options.shutdown_when_idle,
        auto_shutdown=options.auto_shutdown,
    )
    runs = request.config.stash[_RUNS]
    runs[name] = run

    def end() -> None:
        del runs[name]
        try:
            code = run.end()
        finally:
            run.close()
        assert code == 0, f"When tearing down '{name}' launch service failed when finishing, return code '{code}'"

    fixturedef.addfinalizer(end)
    return value


def _launch_mark(node: pytest.Item | pytest.Collector, obj: Any = None) -> pytest.Mark | None:
    marks = [mark for mark in getattr(obj, "pytestmark", ()) if mark.name == "launch"]
    return marks[-1] if marks else node.get_closest_marker("launch")


def _fixture_name(mark: pytest.Mark) -> str:
    fixture = mark.kwargs.get("fixture")
    if fixture is None:
        raise pytest.UsageError('"fixture" keyword argument is required in a pytest.mark.launch() decorator')
    return str(getattr(fixture, "name", None) or fixture.__name__)


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(collector: Any, name: str, obj: Any) -> list[pytest.Item] | None:
    """Collect launch tests, which may also be coroutines and generators, and add their fixture."""
    if not collector.funcnamefilter(name) or not inspect.isfunction(obj):
        return None
    mark = _launch_mark(collector, obj)
    if mark is None:
        return None
    pytest.mark.usefixtures(_fixture_name(mark))(obj)
    return list(collector._genfunctions(name, obj))


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Move tests that run after the end of a launch after the other tests with the same fixture."""
    for item in [item for item in items if _is_after_end(item)]:
        users = [index for index, other in enumerate(items) if _share_launch(other, item)]
        last = max((index for index in users if not _is_after_end(items[index])), default=-1)
        if last > items.index(item):
            items.remove(item)
            items.insert(last, item)


def _is_after_end(item: pytest.Item) -> bool:
    mark = _launch_mark(item)
    return mark is not None and bool(mark.kwargs.get("shutdown", False))


def _share_launch(first: pytest.Item, second: pytest.Item) -> bool:
    marks = _launch_mark(first), _launch_mark(second)
    if marks[0] is None or marks[1] is None or first.path != second.path:
        return False
    return _fixture_name(marks[0]) == _fixture_name(marks[1])


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Run a launch test during its launch, or after the end of the launch."""
    mark = _launch_mark(pyfuncitem)
    if mark is None:
        return None
    run = pyfuncitem.config.stash[_RUNS][_fixture_name(mark)]
    arguments = {name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}
    if _is_after_end(pyfuncitem):
        code = run.end()
        assert code == 0, f"launch service failed when finishing, return code '{code}'"
    run.call(pyfuncitem.obj, arguments)
    return True


def _run_of(request: pytest.FixtureRequest) -> LaunchRun:
    mark = _launch_mark(request.node)
    if mark is None:
        raise pytest.UsageError("this fixture is for tests that are marked with pytest.mark.launch(fixture=...)")
    request.getfixturevalue(_fixture_name(mark))
    return request.config.stash[_RUNS][_fixture_name(mark)]


@pytest.fixture
def launch_service(request: pytest.FixtureRequest) -> LaunchService:
    """The service that runs the launch of this test."""
    return _run_of(request).service


@pytest.fixture
def launch_context(request: pytest.FixtureRequest) -> LaunchContext:
    """The context of the launch of this test."""
    return _run_of(request).service.context


@pytest.fixture
def event_loop(request: pytest.FixtureRequest) -> asyncio.AbstractEventLoop:
    """The event loop in which the launch of this test runs."""
    return _run_of(request).loop
