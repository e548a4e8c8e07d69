"""Callbacks that wait for each other work in turns, in the same order every time."""

from __future__ import annotations

from typing import Any

import pytest

from autograder.lockstep.lockstep_host.crew import Crew, Worker


class Task:
    """A callback as rclpy's task holds it: called once, then done, with what it raised."""

    def __init__(self, callback: Any) -> None:
        self._callback, self._over, self._error = callback, False, None

    def __call__(self) -> None:
        try:
            self._callback()
        except ValueError as error:
            self._error = error
        self._over = True

    def done(self) -> bool:
        return self._over

    def result(self) -> None:
        if self._error is not None:
            raise self._error


def wait(ready: Any) -> None:
    """Wait in the present worker."""
    import threading

    worker = threading.current_thread()
    assert isinstance(worker, Worker)
    worker.wait(ready)


def test_a_callback_that_does_not_wait_is_done_at_once() -> None:
    crew, done = Crew(None), []
    crew.start(Task(lambda: done.append(1)))
    assert done == [1]
    assert not crew.waiting
    assert not crew.resume()


def test_who_waits_goes_on_when_it_is_ready_in_the_order_of_coming() -> None:
    crew, log, gates = Crew(None), [], {"a": False, "b": False}

    def work(name: str) -> None:
        log.append(f"{name} begins")
        wait(lambda: gates[name])
        log.append(f"{name} ends")

    for name in gates:
        crew.start(Task(lambda name=name: work(name)))
    assert log == ["a begins", "b begins"]
    assert not crew.resume()
    gates["b"] = True
    assert crew.resume()
    gates["a"] = True
    assert crew.resume()
    assert log == ["a begins", "b begins", "b ends", "a ends"]
    assert not crew.waiting


def test_no_more_callbacks_wait_than_there_are_threads() -> None:
    crew, gate = Crew(2), []
    for _ in range(2):
        assert not crew.full
        crew.start(Task(lambda: wait(lambda: bool(gate))))
    assert crew.full
    gate.append(1)
    while crew.resume():
        pass
    assert not crew.full


def test_what_a_callback_raises_comes_out_even_after_it_has_waited() -> None:
    def fail() -> None:
        raise ValueError("no lidar")

    def wait_and_fail() -> None:
        wait(lambda: True)
        fail()

    crew = Crew(None)
    with pytest.raises(ValueError, match="no lidar"):
        crew.start(Task(fail))
    crew.start(Task(wait_and_fail))
    with pytest.raises(ValueError, match="no lidar"):
        crew.resume()
