"""The pytest plugin, for which a file whose `generate_test_description` is marked ``launch_test`` is one test."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from _pytest._code.code import ReprFileLocation, TerminalRepr
from _pytest._io import TerminalWriter

ENTRY = "generate_test_description"


class LaunchTestFailure(Exception):
    """The failed tests of a launch, with the text of each failure."""

    def __init__(self, failed: list[tuple[str, str]]) -> None:
        super().__init__("some test cases have failed")
        self.failed = failed


class LaunchTestFailureRepr(TerminalRepr):
    """The text that pytest prints for such a failure."""

    def __init__(self, failed: list[tuple[str, str]]) -> None:
        width = max(len(line) for _, text in failed for line in text.splitlines())
        double_line, single_line = "=" * width, "-" * width
        self._text = "\n" + "\n\n".join(f"{double_line}\nFAIL: {name}\n{single_line}\n{text}" for name, text in failed)
        self.reprcrash = ReprFileLocation("", 0, "\n".join(f"{name} failed" for name, _ in failed))

    def toterminal(self, tw: TerminalWriter) -> None:
        """Print the text."""
        tw.write(self._text)


class LaunchTestItem(pytest.Item):
    """All launches of a file, with their tests."""

    def __init__(self, *, module: ModuleType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._module = module

    def runtest(self) -> None:
        """Run the tests of all launches."""
        from .loader import load_tests
        from .test_runner import run_all

        runs = load_tests(self._module, self.name)
        for run in runs:
            run.validate()
        arguments = [word for words in self.config.getoption("--launch-args") for word in words]
        results = run_all(runs, arguments, debug=bool(self.config.getoption("verbose")))
        failed = [
            (case.id(), text)
            for result in results.values()
            if not result.wasSuccessful()
            for case, text in [*result.errors, *result.failures]
        ]
        if failed:
            raise LaunchTestFailure(failed)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the text of a failure."""
        if isinstance(excinfo.value, LaunchTestFailure):
            return LaunchTestFailureRepr(excinfo.value.failed)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int, str]:
        """Return the file, the line and the title."""
        return self.path, 0, f"launch tests: {self.name}"


class LaunchTestModule(pytest.File):
    """A file with a launch test."""

    def collect(self) -> list[LaunchTestItem]:
        """Return the only item of the file."""
        module = _import(self.path, self.config)
        return [LaunchTestItem.from_parent(self, name=module.__name__, module=module)]


def _import(path: Path, config: pytest.Config) -> ModuleType:
    from _pytest.pathlib import import_path

    options: dict[str, Any] = {"consider_namespace_packages": False} if pytest.version_tuple >= (8, 1) else {}
    return import_path(path, root=config.rootpath, **options)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add `--launch-args`."""
    parser.addoption("--launch-args", action="append", nargs="*", default=[], help="One or more Launch test arguments")


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker."""
    config.addinivalue_line("markers", f"launch_test: mark a {ENTRY} function as a launch test entrypoint")


def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect a launch test; leave every other file to pytest."""
    if ENTRY not in module_path.read_text(encoding="utf-8", errors="replace"):
        return None  # avoids importing the file
    try:
        module = _import(module_path, parent.config)
    except SyntaxError:
        return None  # pytest reports it
    marks = getattr(getattr(module, ENTRY, None), "pytestmark", [])
    if not any(mark.name == "launch_test" for mark in marks):
        return None
    collected: LaunchTestModule = LaunchTestModule.from_parent(parent, path=module_path)
    for mark in marks:
        collected.add_marker(getattr(pytest.mark, mark.name).with_args(*mark.args, **mark.kwargs))
    return collected
