"""Runs callbacks that may block. Each has its own thread, but only one thread runs at a time.

In rclpy's MultiThreadedExecutor, a callback may wait for another callback, for example in `client.call()` or in
`rate.sleep()`. So each callback of such an executor also has a thread here. But a thread runs until it is done or
waits, and then the next one runs, in an order that is always the same.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

Condition = Callable[[], bool]


class Worker(threading.Thread):
    """The thread of a callback that has started.

    Attributes:
        ready: the condition for which it waits; None while it runs.
        is_done: whether its callback has returned.
    """

    def __init__(self, handler: Callable[[], Any], main_turn: threading.Semaphore) -> None:
        super().__init__(daemon=True)
        self.ready: Condition | None = None
        self.is_done = False
        self._handler = handler
        self._turn = threading.Semaphore(0)
        self._main_turn = main_turn

    def run(self) -> None:
        """Run the callback once `proceed` is called."""
        self._turn.acquire()
        try:
            self._handler()
        finally:
            self.is_done = True
            self._main_turn.release()

    def proceed(self) -> None:
        """Let it run until it is done or waits. Call this from the main thread."""
        self.ready = None
        self._turn.release()
        self._main_turn.acquire()

    def wait(self, ready: Condition) -> None:
        """Wait for a condition and let other callbacks run. Call this from the worker's own thread."""
        self.ready = ready
        self._main_turn.release()
        self._turn.acquire()


class CallbackThreads:
    """The callbacks of one executor that have started and are not done."""

    def __init__(self, size: int | None) -> None:
        self.size = size
        self.waiting: list[tuple[Worker, Any]] = []  # the workers, with their rclpy tasks
        self._main_turn = threading.Semaphore(0)

    @property
    def is_full(self) -> bool:
        """Whether all threads are used."""
        return self.size is not None and len(self.waiting) >= self.size

    def start(self, task: Any) -> None:
        """Run a task until it is done or waits. Raises the exceptions of the task."""
        worker = Worker(task, self._main_turn)
        worker.start()
        self._proceed(worker, task)

    def resume(self) -> bool:
        """Let the first worker whose condition is true run. Return whether there is such a worker.

        Raises the exceptions of its task.
        """
        for index, (worker, task) in enumerate(self.waiting):
            if worker.ready is not None and worker.ready():
                del self.waiting[index]
                self._proceed(worker, task)
                return True
        return False

    def _proceed(self, worker: Worker, task: Any) -> None:
        worker.proceed()
        if not worker.is_done:
            self.waiting.append((worker, task))
        elif task.done():
            task.result()
