"""Launches what a test file describes, and runs its tests in a thread beside it, then those after its end."""

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
from .test_result import TestResult, died, skipped


def run_all(
    runs: Sequence[TestRun], launch_arguments: Sequence[str], *, debug: bool = False
) -> dict[TestRun | str, unittest.TestResult]:
    """Make each launch with its tests; return the results. One that ends before its tests is the last one.

    Args:
        runs: the launches.
        launch_arguments: of the form `<name>:=<value>`.
        debug: let the launch tell more.

    Raises:
        RuntimeError: a launch argument has another form.
        Exception: a launch description cannot be tested.
    """
    results: dict[TestRun | str, unittest.TestResult] = {}
    for run in runs:
        if len(runs) > 1:
            print(f"\nStarting test run {run}")
        try:
            found = _Launch(run, parse_launch_arguments(launch_arguments), debug=debug).results()
        except unittest.SkipTest as skip:
            print(f"{run} is skipped: {skip}")
            results[str(run)] = skipped(run, str(skip))
            continue
        results[str(run)] = found or died(run)
        if found is None:
            break
    return results


def parse_launch_arguments(words: Sequence[str]) -> dict[str, str]:
    """Return launch arguments by name, the last one of a name; RuntimeError for one of another form."""
    parsed: dict[str, str] = {}
    for word in words:
        name, sign, value = word.partition(":=")
        if not (sign and name and value):
            raise RuntimeError(f"malformed launch argument '{word}', expected format '<name>:=<value>'")
        parsed[name] = value
    return parsed


class _Launch:
    """One launch. The tests run in a thread, as a launch has to have the main one."""

    def __init__(self, run: TestRun, arguments: Mapping[str, str], *, debug: bool) -> None:
        self._run = run
        self._arguments = dict(arguments)
        self._service = LaunchService(debug=debug)
        self._info = ActiveProcInfoHandler()
        self._output = ActiveIoHandler()
        self._ready = threading.Event()
        self._beside: TestResult | None = None

    def results(self) -> TestResult | None:
        """Return the results of all tests; None if the launch ended before the tests beside it did."""
        description, context = self._run.described(self._ready.set)
        given = self._run.given
        given |= {**context, **self._run.parameters, "test_args": self._arguments}
        given |= {"launch_service": self._service, "proc_info": self._info, "proc_output": self._output}
        self._service.include_launch_description(self._observed(description))
        tests = threading.Thread(target=self._run_beside, name="test_runner_thread", daemon=True)
        tests.start()
        self._service.run(shutdown_when_idle=not self._run.keep_alive)
        if self._beside is None:
            print("Processes under test stopped before tests completed")
            self._tell_of_failed_processes()
            return None
        del given["launch_service"]
        given |= {"proc_info": self._info._proc_info_handler, "proc_output": self._output._io_handler}
        self._beside.append(_run_tests(self._run.after))
        return self._beside

    def _observed(self, description: LaunchDescription) -> LaunchDescription:
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

    def _run_beside(self) -> None:
        if not self._ready.wait(self._run.timeout):
            print("Timed out waiting for processes to start up")
        else:
            self._beside = _run_tests(self._run.beside)
        self._service.shutdown()

    def _tell_of_failed_processes(self) -> None:
        for event in self._info:
            if not isinstance(event, ProcessExited) or event.returncode == 0:
                continue
            print(f"Process '{event.process_name}' exited with {event.returncode}")
            print(f"##### '{event.process_name}' output #####")
            for piece in self._output[event.process_name]:
                print(piece.text.decode())
            print("#" * (len(event.process_name) + 21))


def _run_tests(suite: unittest.TestSuite) -> TestResult:
    return cast(TestResult, unittest.TextTestRunner(verbosity=2, resultclass=TestResult).run(suite))  # type: ignore[arg-type]


__getattr__ = make_getattr(__name__)
