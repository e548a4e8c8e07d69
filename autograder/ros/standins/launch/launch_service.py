"""The service that executes launch descriptions: a loop over events, and an orderly shutdown.

Whether the launch ends by Ctrl-C, a signal, an error or because nothing is left to do, all processes that it has
started have ended when `run` returns.
"""

from __future__ import annotations

import asyncio
import contextlib
import signal
import threading
import traceback
from collections.abc import Coroutine, Iterable, Iterator
from typing import Any

from . import logging as launch_logging
from .action import as_list
from .event import Event
from .event_handlers import OnIncludeLaunchDescription
from .events import IncludeLaunchDescription, Shutdown
from .launch_context import LaunchContext
from .launch_description import LaunchDescription
from .launch_description_entity import LaunchDescriptionEntity

_TERMINATION_SIGNALS = (signal.SIGTERM, signal.SIGQUIT, signal.SIGHUP)


class LaunchService:
    """Executes launch descriptions and the entities that event handlers return."""

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False, debug: bool = False) -> None:
        if debug:
            launch_logging.launch_config.level = 10
        self.context = LaunchContext(argv=argv, noninteractive=noninteractive)
        self.context.register_event_handler(OnIncludeLaunchDescription())
        self._debug = debug
        self._lock = threading.RLock()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._task: asyncio.Task[Any] | None = None
        self._shutting_down = False
        self._return_code = 0
        self._futures: list[asyncio.Future[None]] = []

    @property
    def event_loop(self) -> asyncio.AbstractEventLoop | None:
        """The loop in which the service runs, or None."""
        return self._loop

    @property
    def task(self) -> asyncio.Task[Any] | None:
        """The task in which the service runs, or None."""
        return self._task

    def emit_event(self, event: Event) -> None:
        """Emit `event`, from any thread; the queue keeps it until the service runs."""
        with self._lock:
            if self._loop is None or self._is_in_own_thread():
                self.context.emit_event_sync(event)
            else:
                self._loop.call_soon_threadsafe(self.context.emit_event_sync, event)

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Execute `launch_description`, now or when the service runs; from any thread."""
        self.emit_event(IncludeLaunchDescription(launch_description))

    def shutdown(self, force_sync: bool = False) -> Coroutine[None, None, None] | None:
        """End the launch, from any thread, if it is running.

        Within the running loop this returns a coroutine that ends the launch, unless `force_sync` is set.
        """
        with self._lock:
            if self._loop is None:
                return None
            reason = "LaunchService.shutdown() called"
            if not self._is_in_own_thread():
                self._loop.call_soon_threadsafe(self._begin_shutdown, reason)
                return None

            async def begin_shutdown() -> None:
                self._begin_shutdown(reason)

            if not force_sync and self._is_in_loop():
                return begin_shutdown()
            self._begin_shutdown(reason)
            return None

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run until the launch has ended; return 0, or 1 after an error.

        Raises RuntimeError outside of the main thread.
        """
        _require_main_thread()
        return asyncio.run(self.run_async(shutdown_when_idle=shutdown_when_idle), debug=self._debug or None)

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Run in the running event loop of the main thread, otherwise like `run`."""
        _require_main_thread()
        logger = launch_logging.get_logger("launch")
        with self._running(), self._signal_handlers():
            launch_logging.log_launch_config(logger=logger)
            queue = self.context._event_queue
            next_event = asyncio.ensure_future(queue.get())
            canceled: asyncio.CancelledError | None = None
            try:
                while True:
                    is_idle = self._is_idle() and not next_event.done()
                    if is_idle and self._shutting_down:
                        break
                    if is_idle and shutdown_when_idle:
                        self._begin_shutdown("idle")
                    try:
                        awaited: list[asyncio.Future[Any]] = [next_event, *self._pending()]
                        await asyncio.wait(awaited, return_when=asyncio.FIRST_COMPLETED)
                        self._raise_failures()
                        if next_event.done():
                            event = next_event.result()
                            next_event = asyncio.ensure_future(queue.get())
                            self._handle_event(event)
                    except asyncio.CancelledError as error:
                        logger.error("run task was canceled")
                        if canceled is not None or next_event.cancelled():
                            # Cancelled again, or together with all other tasks: do not wait for an orderly shutdown.
                            raise
                        canceled = error
                        self._fail("run task was canceled")
                    except Exception as error:
                        logger.debug(traceback.format_exc())
                        message = f"Caught exception in launch (see debug for traceback): {error}"
                        logger.error("%s", message)
                        self._fail(message)
            finally:
                next_event.cancel()
                await self._abandon_tasks()
            if canceled is not None:
                raise canceled
            return self._return_code

    def _fail(self, reason: str) -> None:
        self._return_code = 1
        self._begin_shutdown(reason)

    def _begin_shutdown(self, reason: str, *, due_to_sigint: bool = False) -> None:
        if not self._shutting_down:
            self._shutting_down = True
            self.context.emit_event_sync(Shutdown(reason=reason, due_to_sigint=due_to_sigint))
        self.context.is_shutdown = True

    def _pending(self) -> list[asyncio.Future[None]]:
        """Return the futures that are not done."""
        self._futures = [future for future in self._futures if not future.done()]
        completion_futures = self.context._completion_futures
        completion_futures[:] = [future for future in completion_futures if not future.done()]
        return [*self._futures, *completion_futures]

    def _is_idle(self) -> bool:
        return self.context._event_queue.empty() and not self._pending()

    def _raise_failures(self) -> None:
        """Raise the error of a failed future; cancelled ones have not failed."""
        for futures in (self._futures, self.context._completion_futures):
            for future in [future for future in futures if future.done()]:
                futures.remove(future)
                if not future.cancelled():
                    future.result()

    def _handle_event(self, event: Event) -> None:
        """Let each matching handler handle `event`, and visit the entities that it returns."""
        if isinstance(event, Shutdown):
            # Set before all handlers, as a process that they start now would not be shut down.
            self._shutting_down = self.context.is_shutdown = True
        for handler in tuple(self.context._event_handlers):
            if not handler.matches(event):
                continue
            self.context._push_locals()
            try:
                for entity in as_list(handler.handle(event, self.context)) or ():
                    self._visit(entity)
            finally:
                self.context._pop_locals()

    def _visit(self, entity: LaunchDescriptionEntity) -> None:
        """Visit `entity` and its sub-entities in order, and remember their futures."""
        if not isinstance(entity, LaunchDescriptionEntity):
            raise RuntimeError(
                f"expected a LaunchDescriptionEntity such as an action, got {type(entity).__name__}: {entity!r}"
            )
        sub_entities = entity.visit(self.context)
        future = entity.get_asyncio_future()
        if future is not None:
            self._futures.append(future)
        for sub_entity in sub_entities or ():
            self._visit(sub_entity)

    async def _abandon_tasks(self) -> None:
        """Cancel the remaining tasks, which kills their processes; after an orderly shutdown there are none."""
        tasks = tuple(self.context._tasks)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    @contextlib.contextmanager
    def _running(self) -> Iterator[None]:
        with self._lock:
            if self._loop is not None:
                raise RuntimeError("LaunchService.run() called from multiple threads concurrently.")
            self._loop = asyncio.get_running_loop()
            self._task = asyncio.current_task()
            self.context.asyncio_loop = self._loop
            self.context.is_shutdown = self._shutting_down = False
            self._return_code = 0
        try:
            yield
        finally:
            with self._lock:
                self._loop = None
                self.context.asyncio_loop = None

    @contextlib.contextmanager
    def _signal_handlers(self) -> Iterator[None]:
        """Shut the launch down in an orderly way on signals that end a program."""
        loop = asyncio.get_running_loop()
        numbers = (signal.SIGINT, *_TERMINATION_SIGNALS)
        previous = {number: signal.getsignal(number) for number in numbers}
        for number in numbers:
            loop.add_signal_handler(number, self._on_signal, number)
        try:
            yield
        finally:
            for number, handler in previous.items():
                loop.remove_signal_handler(number)
                if handler is not None:
                    signal.signal(number, handler)

    def _on_signal(self, number: signal.Signals) -> None:
        logger = launch_logging.get_logger("launch")
        if number is not signal.SIGINT:
            logger.warning("received %s, terminating...", number.name)
            self._fail(f"received {number.name}")
            return
        message = "user interrupted with ctrl-c (SIGINT)"
        if self._shutting_down:
            logger.warning("%s again, ignoring...", message)
        else:
            logger.warning(message)
            self._begin_shutdown("ctrl-c (SIGINT)", due_to_sigint=True)

    def _is_in_own_thread(self) -> bool:
        # The service runs in the main thread only.
        return threading.current_thread() is threading.main_thread()

    def _is_in_loop(self) -> bool:
        try:
            return asyncio.get_running_loop() is self._loop
        except RuntimeError:
            return False


def _require_main_thread() -> None:
    if threading.current_thread() is not threading.main_thread():
        raise RuntimeError("LaunchService can only be run in the main thread.")
