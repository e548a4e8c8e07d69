"""The action that runs a process and waits until it has ended."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import traceback
from collections.abc import Mapping
from typing import Any, cast

from .._launch_event_handlers import OnShutdown
from .._output import OutputText
from .._process import ChildProcess
from ..action import Action, running_loop
from ..conditions import evaluate_condition_expression
from ..descriptions import Executable
from ..event import Event
from ..event_handler import EventCallback, EventHandler, OnActionEventBase
from ..events import Shutdown
from ..events.process import (
    ProcessExited,
    ProcessStarted,
    ProcessStderr,
    ProcessStdout,
    ProcessTargetedEvent,
    ShutdownProcess,
    SignalProcess,
)
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity, OptionalEntities, SomeEntitiesType
from ..logging import get_logger, get_output_loggers
from ..substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from ..substitutions import LaunchConfiguration
from ..utilities.type_utils import normalize_typed_substitution, perform_typed_substitution
from .opaque_function import OpaqueFunction


class ExecuteLocal(Action):
    """Runs an executable; emits events when it starts, writes and exits.

    At the end of the launch the process gets SIGINT. If it keeps running, it gets SIGTERM after `sigterm_timeout`
    seconds, and SIGKILL `sigkill_timeout` seconds later.
    """

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        sigterm_timeout: SomeSubstitutionsType | None = None,
        sigkill_timeout: SomeSubstitutionsType | None = None,
        emulate_tty: bool = False,
        output: SomeSubstitutionsType | Mapping[str, Any] = "log",
        output_format: str = "[{this.process_description.final_name}] {line}",
        cached_output: bool = False,
        log_cmd: bool = False,
        on_exit: SomeEntitiesType | EventCallback | None = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | None = None,
        respawn_max_retries: int = -1,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.process_description = process_description
        self.shell = shell
        self.sigterm_timeout = normalize_to_list_of_substitutions(
            LaunchConfiguration("sigterm_timeout", default=5) if sigterm_timeout is None else sigterm_timeout
        )
        self.sigkill_timeout = normalize_to_list_of_substitutions(
            LaunchConfiguration("sigkill_timeout", default=5) if sigkill_timeout is None else sigkill_timeout
        )
        self.emulate_tty = emulate_tty
        output = os.environ.get("OVERRIDE_LAUNCH_PROCESS_OUTPUT", output)
        self.output = output if isinstance(output, Mapping) else normalize_to_list_of_substitutions(output)
        self._output_format = output_format
        self._cached_output = cached_output
        self._log_cmd = log_cmd
        self._on_exit = on_exit
        self._respawn = normalize_typed_substitution(respawn, bool)
        self._respawn_delay = respawn_delay or 0.0
        self._remaining_respawns = respawn_max_retries
        self._streams = {source: OutputText(keep=cached_output) for source in ("stdout", "stderr")}
        self._loggers: dict[str, logging.Logger] = {}
        self._details: dict[str, Any] | None = None
        self._child: ChildProcess | None = None
        self._shutdown_requested: asyncio.Future[bool] | None = None
        self._completion: asyncio.Future[None] | None = None

    @property
    def process_details(self) -> dict[str, Any] | None:
        """The action, name, pid, cmd, cwd and env of the process, or None before it is prepared."""
        return self._details

    @property
    def return_code(self) -> int | None:
        """The exit code of the last process, or None if none has ended."""
        return None if self._child is None else self._child.returncode

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities of `on_exit`."""
        return list(self._on_exit) if isinstance(self._on_exit, (list, tuple)) else []

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return the future that completes when the process has ended and is not respawned."""
        return self._completion

    def get_stdout(self) -> str:
        """Return all standard output so far; RuntimeError unless `cached_output` is set."""
        return self._cached_text("stdout")

    def get_stderr(self) -> str:
        """Return all standard error so far; RuntimeError unless `cached_output` is set."""
        return self._cached_text("stderr")

    def _cached_text(self, source: str) -> str:
        if not self._cached_output:
            raise RuntimeError(
                f"cached output must be true to be able to get {source}, proc '{self.process_description.final_name}'"
            )
        return self._streams[source].text

    def prepare(self, context: LaunchContext) -> None:
        """Perform the substitutions of the process."""
        description = self.process_description
        description.prepare(context, self)
        self._details = {
            "action": self,
            "name": description.final_name,
            "cmd": description.final_cmd,
            "cwd": description.final_cwd,
            "env": description.final_env,
        }
        self._respawn = perform_typed_substitution(context, self._respawn, bool)

    def execute(self, context: LaunchContext) -> OptionalEntities:
        """Start the process, unless the launch is already shutting down."""
        self.prepare(context)
        name = self.process_description.final_name
        if self._completion is not None:
            raise RuntimeError(f"ExecuteLocal action '{name}': executed more than once: {self.describe()}")
        if context.is_shutdown:
            return None
        output = self.output if isinstance(self.output, Mapping) else perform_substitutions(context, self.output)
        self._logger = get_logger(name)
        self._loggers = dict(zip(("stdout", "stderr"), get_output_loggers(name, output), strict=True))
        loop = running_loop(context)
        self._completion = loop.create_future()
        self._shutdown_requested = loop.create_future()
        context.register_event_handler(
            EventHandler(matcher=self._matches, entities=OpaqueFunction(function=self._on_targeted_event))
        )
        context.register_event_handler(OnShutdown(on_shutdown=self._on_shutdown))
        if self._on_exit is not None:
            # This equals an `OnProcessExit`, which this module cannot import, as that imports this module.
            on_exit = OnActionEventBase(
                action_matcher=self,
                on_event=self._on_exit,
                target_event_cls=ProcessExited,
                target_action_cls=ExecuteLocal,
            )
            context.register_event_handler(on_exit)
        context.start_task(self._run(context))
        return None

    def _matches(self, event: Event) -> bool:
        return isinstance(event, ProcessTargetedEvent) and event.process_matcher(self)

    def _on_targeted_event(self, context: LaunchContext) -> None:
        event = context.locals.event
        if isinstance(event, ShutdownProcess):
            self._request_shutdown(is_quiet=False)
        elif isinstance(event, SignalProcess):
            if self._child is None:
                raise RuntimeError("Signal event received before execution.")
            if self._child.returncode is None:
                name = self.process_description.final_name
                self._logger.info("sending signal '%s' to process[%s]", event.signal_name, name)
            self._child.send_signal(event.signal)

    def _on_shutdown(self, event: Event, context: LaunchContext) -> None:
        self._request_shutdown(is_quiet=cast(Shutdown, event).due_to_sigint and not context.noninteractive)

    def _request_shutdown(self, *, is_quiet: bool) -> None:
        if self._shutdown_requested is not None and not self._shutdown_requested.done():
            self._shutdown_requested.set_result(is_quiet)

    def _emit_signal(self, context: LaunchContext, number: signal.Signals) -> None:
        context.emit_event_sync(SignalProcess(signal_number=number, process_matcher=lambda action: action is self))

    async def _run(self, context: LaunchContext) -> None:
        """Run the process, and respawn it as configured."""
        assert self._completion is not None
        try:
            while await self._run_once(context) and await self._should_respawn(context):
                pass
        except Exception as error:
            self._completion.set_exception(error)
        finally:
            if not self._completion.done():
                self._completion.set_result(None)

    async def _should_respawn(self, context: LaunchContext) -> bool:
        assert self._shutdown_requested is not None
        if not self._respawn or self._remaining_respawns == 0 or context.is_shutdown:
            return False
        self._remaining_respawns -= 1
        await asyncio.wait([self._shutdown_requested], timeout=self._respawn_delay)
        return not self._shutdown_requested.done()

    async def _run_once(self, context: LaunchContext) -> bool:
        """Run the process once; return whether it could be started."""
        description, details = self.process_description, self._details
        assert details is not None
        command = " ".join(part for part in description.final_cmd if part.strip())
        if self._log_cmd:
            self._logger.info("process details: cmd='%s', cwd='%s', custom_env?=True", command, description.final_cwd)

        def on_output(source: str, data: bytes) -> None:
            self._log(source, self._streams[source].lines(data))
            event = ProcessStdout if source == "stdout" else ProcessStderr
            context.emit_event_sync(event(text=data, **details))

        try:
            child = await ChildProcess.start(
                description.final_cmd,
                cwd=description.final_cwd,
                env=description.final_env,
                shell=self.shell,
                emulate_tty=self._emulates_tty(context),
            )
        except (OSError, ValueError) as error:
            reason = "".join(traceback.format_exception_only(error)).rstrip()
            self._logger.error("exception occurred while executing process:\n%s", reason)
            return False
        try:
            self._child = child
            details["pid"] = child.pid
            self._logger.info("process started with pid [%d]", child.pid)
            context.emit_event_sync(ProcessStarted(**details))
            await child.read(on_output)
            await self._wait_or_end(context, child)
            returncode = await child.finish()
        except BaseException:
            await child.kill()
            raise
        for source, stream in self._streams.items():
            self._log(source, stream.last_line())
        if returncode == 0:
            self._logger.info("process has finished cleanly [pid %d]", child.pid)
        else:
            self._logger.error("process has died [pid %d, exit code %d, cmd '%s'].", child.pid, returncode, command)
        context.emit_event_sync(ProcessExited(returncode=returncode, **details))
        return True

    async def _wait_or_end(self, context: LaunchContext, child: ChildProcess) -> None:
        """Wait until the process has exited; end it when its shutdown is requested."""
        assert self._shutdown_requested is not None
        exit_or_request: list[asyncio.Future[Any]] = [child.exited, self._shutdown_requested]
        await asyncio.wait(exit_or_request, return_when=asyncio.FIRST_COMPLETED)
        if child.exited.done():
            return
        sigterm_seconds = float(perform_substitutions(context, self.sigterm_timeout))
        sigkill_seconds = float(perform_substitutions(context, self.sigkill_timeout))
        if self._shutdown_requested.result():
            child.send_signal(signal.SIGINT)  # not logged, because with the real launch the terminal sends it
        else:
            self._emit_signal(context, signal.SIGINT)
        for seconds, total_seconds, previous_signal, next_signal in (
            (sigterm_seconds, sigterm_seconds, signal.SIGINT, signal.SIGTERM),
            (sigkill_seconds, sigterm_seconds + sigkill_seconds, signal.SIGTERM, signal.SIGKILL),
        ):
            await asyncio.wait([child.exited], timeout=seconds)
            if child.exited.done():
                return
            self._logger.error(
                "process[%s] failed to terminate '%g' seconds after receiving '%s', escalating to '%s'",
                self.process_description.final_name,
                total_seconds,
                previous_signal.name,
                next_signal.name,
            )
            self._emit_signal(context, next_signal)

    def _emulates_tty(self, context: LaunchContext) -> bool:
        if "emulate_tty" not in context.launch_configurations:
            return self.emulate_tty
        value = context.launch_configurations["emulate_tty"]
        return evaluate_condition_expression(context, normalize_to_list_of_substitutions(value))

    def _log(self, source: str, lines: list[str]) -> None:
        for line in lines:
            self._loggers[source].info("%s", self._output_format.format(line=line, this=self))
