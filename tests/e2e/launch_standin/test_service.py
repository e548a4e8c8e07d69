"""The launch service, used by other programs with threads, event loops, errors and cancellation."""

from __future__ import annotations

import asyncio
import os
import signal
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import launch
import pytest
from launch.actions import (
    EmitEvent,
    ExecuteProcess,
    LogInfo,
    OpaqueCoroutine,
    OpaqueFunction,
    RegisterEventHandler,
    Shutdown,
    TimerAction,
    UnregisterEventHandler,
)
from launch.event_handlers import OnProcessExit, OnProcessStart, OnShutdown
from launch.events.process import SignalProcess, matches_executable, matches_name, matches_pid

pytestmark = pytest.mark.usefixtures("own_log")


def sleeper(**options: Any) -> ExecuteProcess:
    return ExecuteProcess(cmd=["sleep", "3600"], **options)


def service_with(*entities: Any) -> launch.LaunchService:
    service = launch.LaunchService()
    service.include_launch_description(launch.LaunchDescription(entities))
    return service


def when_started(action: ExecuteProcess, do: Callable[[], Any]) -> RegisterEventHandler:
    return RegisterEventHandler(OnProcessStart(target_action=action, on_start=lambda event, context: do()))


def has_ended(action: ExecuteProcess) -> bool:
    assert action.process_details is not None
    return not Path("/proc", str(action.process_details["pid"])).exists()


def test_another_thread_can_shut_the_launch_down() -> None:
    action = sleeper()
    service = service_with(action, when_started(action, lambda: threading.Thread(target=service.shutdown).start()))
    assert service.run() == 0
    assert action.return_code == -signal.SIGINT
    assert has_ended(action)


def test_another_thread_can_add_to_a_running_launch(capsys: pytest.CaptureFixture[str]) -> None:
    action = sleeper()

    def add() -> None:
        service.include_launch_description(launch.LaunchDescription([LogInfo(msg="added"), Shutdown()]))

    service = service_with(action, when_started(action, lambda: threading.Thread(target=add).start()))
    assert service.run() == 0
    assert "[launch.user]: added" in capsys.readouterr().out


def test_shutdown_of_a_launch_that_does_not_run_does_nothing() -> None:
    assert launch.LaunchService().shutdown() is None


def test_shutdown_within_the_loop_returns_a_coroutine() -> None:
    action = sleeper()

    async def stop(context: launch.LaunchContext) -> None:
        coroutine = service.shutdown()
        assert coroutine is not None
        await coroutine

    service = service_with(action, OpaqueCoroutine(coroutine=stop))
    assert service.run() == 0
    assert has_ended(action)


def test_a_launch_can_run_within_a_loop_that_runs_already() -> None:
    async def main() -> tuple[int, bool]:
        action = sleeper()
        service = service_with(action, when_started(action, lambda: service.shutdown(force_sync=True)))
        return await service.run_async(), has_ended(action)

    assert asyncio.run(main()) == (0, True)


def test_a_launch_outside_of_the_main_thread_is_refused() -> None:
    errors: list[Exception] = []

    def work() -> None:
        try:
            launch.LaunchService().run()
        except RuntimeError as error:
            errors.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert [str(error) for error in errors] == ["LaunchService can only be run in the main thread."]


def test_a_service_runs_once_at_a_time() -> None:
    async def run_again(context: launch.LaunchContext) -> None:
        with pytest.raises(RuntimeError, match="called from multiple threads concurrently"):
            await service.run_async()

    service = service_with(OpaqueCoroutine(coroutine=run_again))
    assert service.run() == 0


def test_a_cancelled_launch_ends_its_processes_before_the_cancellation_continues() -> None:
    action = sleeper()

    async def main() -> None:
        service = service_with(action, when_started(action, lambda: task.cancel()))
        task = asyncio.ensure_future(service.run_async())
        with pytest.raises(asyncio.CancelledError):
            await task
        assert has_ended(action)

    asyncio.run(main())
    assert action.return_code == -signal.SIGINT


@pytest.mark.parametrize("error", [SystemExit, KeyboardInterrupt])
def test_an_exit_raised_in_a_launch_file_leaves_no_process(error: type[BaseException]) -> None:
    action = sleeper()

    def exit_launch() -> None:
        raise error

    with pytest.raises(error):
        service_with(action, when_started(action, exit_launch)).run()
    assert has_ended(action)


def test_an_error_in_a_handler_ends_the_launch_with_it(capsys: pytest.CaptureFixture[str]) -> None:
    action = sleeper()

    def fail() -> None:
        raise ValueError("no such robot")

    assert service_with(action, when_started(action, fail)).run() == 1
    assert "Caught exception in launch (see debug for traceback): no such robot" in capsys.readouterr().out
    assert has_ended(action)


def test_an_error_in_a_coroutine_ends_the_launch_with_it(capsys: pytest.CaptureFixture[str]) -> None:
    async def fail(context: launch.LaunchContext) -> None:
        raise ValueError("no such robot")

    action = sleeper()
    assert service_with(action, OpaqueCoroutine(coroutine=fail)).run() == 1
    assert "Caught exception in launch (see debug for traceback): no such robot" in capsys.readouterr().out
    assert has_ended(action)


def test_the_end_of_the_launch_cancels_coroutines_and_timers() -> None:
    messages: list[str] = []

    async def wait_long(context: launch.LaunchContext) -> None:
        try:
            await asyncio.sleep(3600)
        except asyncio.CancelledError:
            messages.append("cancelled")
            raise

    timer = TimerAction(period=3600.0, actions=[OpaqueFunction(function=lambda context: messages.append("never"))])
    stop = TimerAction(period=0.05, actions=[Shutdown()])
    assert service_with(timer, OpaqueCoroutine(coroutine=wait_long), stop).run() == 0
    assert messages == ["cancelled"]


def test_a_launch_restores_the_signal_handlers() -> None:
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
    before = [signal.getsignal(number) for number in numbers]
    service_with(LogInfo(msg="short")).run()
    assert [signal.getsignal(number) for number in numbers] == before


def test_a_service_without_shutdown_when_idle_waits_for_its_shutdown() -> None:
    service = service_with(LogInfo(msg="nothing more to do"))
    timer = threading.Timer(0.2, service.shutdown)
    timer.start()
    assert service.run(shutdown_when_idle=False) == 0
    timer.join()


def test_a_signal_goes_to_the_processes_that_match() -> None:
    exit_codes: list[int] = []
    actions = [sleeper(), sleeper(), sleeper(name="third")]

    def send() -> Any:
        details = [action.process_details or {} for action in actions]
        return [
            EmitEvent(event=SignalProcess(signal_number="SIGUSR1", process_matcher=matches_pid(details[0]["pid"]))),
            EmitEvent(event=SignalProcess(signal_number=12, process_matcher=matches_name(details[1]["name"]))),
            EmitEvent(event=SignalProcess(signal_number=15, process_matcher=lambda action: action is actions[2])),
        ]

    exits = [
        RegisterEventHandler(OnProcessExit(target_action=action, on_exit=lambda e, c: exit_codes.append(e.returncode)))
        for action in actions
    ]
    service = service_with(*exits, *actions, when_started(actions[2], send))
    assert service.run() == 0
    assert sorted(exit_codes) == [-15, -12, -10]
    assert matches_executable("sleep")(actions[0])
    assert not matches_executable("sheep")(actions[0])


def test_an_action_is_executed_once(capsys: pytest.CaptureFixture[str]) -> None:
    action = ExecuteProcess(cmd=["true"])
    assert service_with(action, action).run() == 1
    error = "executed more than once: ExecuteProcess(cmd=['true'], cwd=None, env=None, shell=False)"
    assert error in capsys.readouterr().out


def test_no_process_is_started_once_the_launch_ends() -> None:
    process = ExecuteProcess(cmd=["true"])
    handler = RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: process))
    assert service_with(handler, Shutdown()).run() == 0
    assert process.return_code is None


def test_a_timer_that_begins_during_shutdown_does_not_delay_it() -> None:
    timer = TimerAction(period=3600.0, actions=[LogInfo(msg="never")])
    assert service_with(RegisterEventHandler(OnShutdown(on_shutdown=[timer])), Shutdown()).run() == 0


def test_a_handler_can_be_removed_or_run_only_once(capsys: pytest.CaptureFixture[str]) -> None:
    removed = OnProcessStart(on_start=[LogInfo(msg="removed")])
    handler = OnProcessStart(on_start=lambda event, context: LogInfo(msg="once"), handle_once=True)
    actions = [RegisterEventHandler(removed), RegisterEventHandler(handler), UnregisterEventHandler(removed)]
    service_with(*actions, ExecuteProcess(cmd=["true"]), ExecuteProcess(cmd=["true"])).run()
    out = capsys.readouterr().out
    assert (out.count("[launch.user]: once"), out.count("[launch.user]: removed")) == (1, 0)


def test_each_child_leads_its_own_process_group() -> None:
    groups: list[int] = []
    action = sleeper()

    def record_group() -> Shutdown:
        assert action.process_details is not None
        groups.append(os.getpgid(action.process_details["pid"]))
        return Shutdown()

    service_with(action, when_started(action, record_group)).run()
    assert action.process_details is not None
    assert groups == [action.process_details["pid"]]
