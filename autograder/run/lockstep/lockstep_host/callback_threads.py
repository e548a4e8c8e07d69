"""Callback threads: callbacks that may block, of which one runs at a time.

A callback may wait for what only another callback brings: `client.call()`, `rate.sleep()`, an event. In rclpy's
MultiThreadedExecutor it may. Here each callback of such an executor has a thread as well, but one thread runs until it
is done or waits, and then the next, in the same order every time.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

Condition = Callable[[], bool]


class Worker(threading.Thread):
    """The thread of a callback that has started.

    Attributes:
        ready: whether what it waits for has come; None while it runs.
        over: whether it is done.
    """

    def __init__(self, handler: Callable[[], Any], back: threading.Semaphore) -> None:
        super().__init__(daemon=True)
        self.ready: Condition | None = None
        self.over = False
        self._handler = handler
        self._turn = threading.Semaphore(0)
        self._back = back

    def run(self) -> None:
        """Run the callback once `go_on` is called."""
        self._turn.acquire()
        try:
            self._handler()
        finally:
            self.over = True
            self._back.release()

    def go_on(self) -> None:
        """Let it run until it is done or waits; called by the main thread."""
        self.ready = None
        self._turn.release()
        self._back.acquire()

    def wait(self, ready: Condition) -> None:
        """Wait for a condition and let other callbacks run; called by its own thread."""
        self.ready = ready
        self._back.release()
        self._turn.acquire()


class CallbackThreads:
    """The callbacks of one executor that have started and are not done."""

    def __init__(self, size: int | None) -> None:
        self.size = size
        self.waiting: list[tuple[Worker, Any]] = []  # with their rclpy tasks
        self._back = threading.Semaphore(0)

    @property
    def full(self) -> bool:
        """Whether there is no thread left for another callback."""
        return self.size is not None and len(self.waiting) >= self.size

    def start(self, task: Any) -> None:
        """Run a task until it is done or waits. Raises what it raised."""
        worker = Worker(task, self._back)
        worker.start()
        self._go_on(worker, task)

    def resume(self) -> bool:
        """Let the first one run whose condition holds; return whether there was one. Raises what it raised."""
        for number, (worker, task) in enumerate(self.waiting):
            if worker.ready is not None and worker.ready():
                del self.waiting[number]
                self._go_on(worker, task)
                return True
        return False

    def _go_on(self, worker: Worker, task: Any) -> None:
        worker.go_on()
        if not worker.over:
            self.waiting.append((worker, task))
        elif task.done():
            task.result()
