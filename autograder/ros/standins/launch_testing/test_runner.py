"""Runs the launches of a test file, with its tests in a thread during each launch and after its end."""

from __future__ import annotations

import threading
import unittest
from collections.abc import Mapping, Sequence
from typing import cast

from launch import LaunchDescription, LaunchDescriptionSource, LaunchService
from launch.actions import IncludeLaunchDescription, RegisterEventHandler
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from launch.events.process import ProcessExited
from standin_notice import make_getattr

from .io_handler import ActiveIoHandler
from .loader import TestRun
from .proc_info_handler import ActiveProcInfoHandler
from .test_result import TestResult, failed_result, skipped_result


def run_all(
    runs: Sequence[TestRun], launch_arguments: Sequence[str], *, debug: bool = False
) -> dict[TestRun | str, unittest.TestResult]:
    """Run each launch with its tests, up to the first that ends before its tests; return the results.

    Args:
        runs: the launches.
        launch_arguments: texts of the form `<name>:=<value>`.
        debug: whether the launch logs more.

    Raises:
        RuntimeError: a launch argument has another form.
        Exception: a launch description cannot be tested.
    """
    results: dict[TestRun | str, unittest.TestResult] = {}
    for run in runs:
        if len(runs) > 1:
            print(f"\nStarting test run {run}")
        try:
            result = _Launch(run, parse_launch_arguments(launch_arguments), debug=debug).run()
        except unittest.SkipTest as skip:
            print(f"{run} is skipped: {skip}")
            results[str(run)] = skipped_result(run, str(skip))
            continue
        results[str(run)] = result or failed_result(run)
        if result is None:
            break
    return results


def parse_launch_arguments(words: Sequence[str]) -> dict[str, str]:
    """Return launch arguments by name; the last one of a name counts. Raise RuntimeError for another form."""
    parsed: dict[str, str] = {}
    for word in words:
        name, sign, value = word.partition(":=")
        if not (sign and name and value):
            raise RuntimeError(f"malformed launch argument '{word}', expected format '<name>:=<value>'")
        parsed[name] = value
    return parsed


class _Launch:
    """One launch. Its tests run in another thread, because a launch needs the main thread."""

    def __init__(self, run: TestRun, arguments: Mapping[str, str], *, debug: bool) -> None:
        self._test_run = run
        self._arguments = dict(arguments)
        self._service = LaunchService(debug=debug)
        self._info = ActiveProcInfoHandler()
        self._output = ActiveIoHandler()
        self._ready = threading.Event()
        self._active_result: TestResult | None = None

    def run(self) -> TestResult | None:
        """Run all tests and return their results, or None if the launch ended before its tests."""
        description, context = self._test_run.describe(self._ready.set)
        arguments = self._test_run.arguments
        arguments |= {**context, **self._test_run.parameters, "test_args": self._arguments}
        arguments |= {"launch_service": self._service, "proc_info": self._info, "proc_output": self._output}
        self._service.include_launch_description(self._with_handlers(description))
        thread = threading.Thread(target=self._run_active_tests, name="test_runner_thread", daemon=True)
        thread.start()
        self._service.run(shutdown_when_idle=not self._test_run.keep_alive)
        if self._active_result is None:
            print("Processes under test stopped before tests completed")
            self._print_failed_processes()
            return None
        del arguments["launch_service"]
        arguments |= {"proc_info": self._info._proc_info_handler, "proc_output": self._output._io_handler}
        self._active_result.append(_run_tests(self._test_run.post_shutdown_tests))
        return self._active_result

    def _with_handlers(self, description: LaunchDescription) -> LaunchDescription:
        def on_start(event: object, _: object) -> None:
            self._info.append(event)  # type: ignore[arg-type]
            self._output.track(event.process_name)  # type: ignore[attr-defined]

        def on_exit(event: object, _: object) -> None:
            self._info.append(event)  # type: ignore[arg-type]

        handlers = (
            OnProcessStart(on_start=on_start),
            OnProcessExit(on_exit=on_exit),
            OnProcessIO(on_stdout=self._output.append, on_stderr=self._output.append),
        )
        source = LaunchDescriptionSource(launch_description=description)
        included = IncludeLaunchDescription(source, launch_arguments=self._arguments.items())
        return LaunchDescription([*map(RegisterEventHandler, handlers), included])

    def _run_active_tests(self) -> None:
        if not self._ready.wait(self._test_run.timeout):
            print("Timed out waiting for processes to start up")
        else:
            self._active_result = _run_tests(self._test_run.active_tests)
        self._service.shutdown()

    def _print_failed_processes(self) -> None:
        for event in self._info:
            if not isinstance(event, ProcessExited) or event.returncode == 0:
                continue
            print(f"Process '{event.process_name}' exited with {event.returncode}")
            print(f"##### '{event.process_name}' output #####")
            for output in self._output[event.process_name]:
                print(output.text.decode())
            print("#" * (len(event.process_name) + 21))


def _run_tests(suite: unittest.TestSuite) -> TestResult:
    return cast(TestResult, unittest.TextTestRunner(verbosity=2, resultclass=TestResult).run(suite))  # type: ignore[arg-type]


__getattr__ = make_getattr(__name__)
