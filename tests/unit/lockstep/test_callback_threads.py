"""Callbacks that wait for each other take turns, always in the same order."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from autograder.run.lockstep.lockstep_host.callback_threads import CallbackThreads, Worker


class Task:
    """A callback like a task of rclpy: called once, then done, with the exception that it raised."""

    def __init__(self, callback: Any) -> None:
        self._callback, self._done = callback, False
        self._error: ValueError | None = None

    def __call__(self) -> None:
        try:
            self._callback()
        except ValueError as error:
            self._error = error
        self._done = True

    def done(self) -> bool:
        return self._done

    def result(self) -> None:
        if self._error is not None:
            raise self._error


def wait(ready: Any) -> None:
    """Wait in the current worker thread."""
    worker = threading.current_thread()
    assert isinstance(worker, Worker)
    worker.wait(ready)


def test_a_callback_that_does_not_wait_is_done_at_once() -> None:
    threads, calls = CallbackThreads(None), []
    threads.start(Task(lambda: calls.append(1)))
    assert calls == [1]
    assert not threads.waiting
    assert not threads.resume()


def test_waiting_callbacks_continue_when_ready_in_the_order_of_their_start() -> None:
    threads, log, gates = CallbackThreads(None), [], {"a": False, "b": False}

    def work(name: str) -> None:
        log.append(f"{name} begins")
        wait(lambda: gates[name])
        log.append(f"{name} ends")

    for name in gates:
        threads.start(Task(lambda name=name: work(name)))
    assert log == ["a begins", "b begins"]
    assert not threads.resume()
    gates["b"] = True
    assert threads.resume()
    gates["a"] = True
    assert threads.resume()
    assert log == ["a begins", "b begins", "b ends", "a ends"]
    assert not threads.waiting


def test_no_more_callbacks_wait_than_there_are_threads() -> None:
    threads, gate = CallbackThreads(2), threading.Event()
    for _ in range(2):
        assert not threads.is_full
        threads.start(Task(lambda: wait(gate.is_set)))
    assert threads.is_full
    gate.set()
    while threads.resume():
        pass
    assert not threads.is_full


def test_an_exception_of_a_callback_is_raised_even_after_it_has_waited() -> None:
    def fail() -> None:
        raise ValueError("no lidar")

    def wait_and_fail() -> None:
        wait(lambda: True)
        fail()

    threads = CallbackThreads(None)
    with pytest.raises(ValueError, match="no lidar"):
        threads.start(Task(fail))
    threads.start(Task(wait_and_fail))
    with pytest.raises(ValueError, match="no lidar"):
        threads.resume()
