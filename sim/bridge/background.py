"""Runs the node beside the student's node in a notebook, in a separate thread and with a separate context.

    >>> with Bridge("assets/worlds/lab.yaml", speed=2.0) as bridge:
    ...     view = live(bridge)

The caller's rclpy is not changed: the node does not use the default context, and installs no signal handler.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions

from sim.bridge.driver import Driver
from sim.bridge.node import SimulatorNode
from sim.bridge.settings import SETTINGS
from sim.exceptions import SpecError
from sim.simulation import Simulation

THREAD_TIMEOUT_SECONDS = 10.0  # the longest time that a call waits for the node's thread


class Bridge:
    """A running simulator node. `settings` are the node's parameters by name, as in `sim.bridge.settings`.

    Raises:
        WorldError: the world cannot be read.
        SpecError: the settings contradict each other.
        rclpy.exceptions.ParameterException: a setting is out of range or has the wrong type.
    """

    def __init__(self, world: str | Path, *, domain_id: int | None = None, **settings: Any) -> None:
        unknown_names = sorted(set(settings) - {setting.name for setting in SETTINGS})
        if unknown_names:
            known_names = ", ".join(setting.name for setting in SETTINGS)
            raise SpecError(f"the simulator has no setting {unknown_names[0]!r}; it has {known_names}")
        overrides = [Parameter(name, value=value) for name, value in {"world": str(world), **settings}.items()]
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain_id, signal_handler_options=SignalHandlerOptions.NO)
        try:
            self._node = SimulatorNode(context=self._context, parameter_overrides=overrides)
        except BaseException:
            self._context.try_shutdown()
            raise
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, name="simulator", daemon=True)
        self._thread.start()

    @property
    def simulation(self) -> Simulation:
        """The parameters of the run."""
        return self._node.driver.simulation

    @property
    def driver(self) -> Driver:
        """The run, which may be inspected but not stepped."""
        return self._node.driver

    @property
    def paused(self) -> bool:
        """Whether simulated time is stopped."""
        return self._node.paused

    @property
    def running(self) -> bool:
        """Whether the node still runs."""
        return self._thread.is_alive()

    def pause(self) -> None:
        """Stop simulated time.

        Raises:
            RuntimeError: the bridge has been stopped. `resume`, `step` and `reset` also raise it.
        """
        self._on_thread(lambda: self._node.pause(True))

    def resume(self) -> None:
        """Continue simulated time."""
        self._on_thread(lambda: self._node.pause(False))

    def step(self, seconds: float) -> None:
        """Pause, and simulate `seconds`."""
        self._on_thread(lambda: self._node.step(seconds))

    def reset(self) -> None:
        """Return to the start."""
        self._on_thread(self._node.reset)

    def stop(self) -> None:
        """Stop the node and its thread. A second call does nothing."""
        if self.running:  # end between two callbacks, because a callback that publishes would fail without its context
            self._executor.create_task(self._context.try_shutdown)
            self._thread.join(THREAD_TIMEOUT_SECONDS)
        self._context.try_shutdown()

    def __enter__(self) -> Bridge:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, tb: TracebackType | None) -> None:
        self.stop()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            pass
        finally:
            self._executor.shutdown(timeout_sec=0.0)
            self._node.destroy_node()

    def _on_thread(self, action: Callable[[], Any]) -> None:
        if not self.running:
            raise RuntimeError("the simulator has been stopped: make a new Bridge")
        done = threading.Event()

        def act() -> None:
            try:
                action()
            finally:
                done.set()

        self._executor.create_task(act)
        if not done.wait(THREAD_TIMEOUT_SECONDS):
            raise TimeoutError(f"the simulator did not answer within {THREAD_TIMEOUT_SECONDS:.0f} s")
