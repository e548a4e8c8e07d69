"""Waiting for the graph ends between two turns of the executor, never in the middle of one."""

from __future__ import annotations

import signal
from typing import Any, cast

import pytest

from autograder.ros.ros2.session import Session, deferred_signals


class InterruptedExecutor:
    """An executor that receives Ctrl-C in its first turn."""

    def __init__(self) -> None:
        self.turns = 0

    def spin_once(self, timeout_sec: float) -> None:
        """Take a turn, and count it at its end."""
        if self.turns == 0:
            signal.raise_signal(signal.SIGINT)
        self.turns += 1


def test_an_interrupted_turn_of_the_executor_is_completed() -> None:
    executor = InterruptedExecutor()
    session = Session(cast("Any", None), cast("Any", executor), None)
    with pytest.raises(KeyboardInterrupt):
        session.spin()
    assert executor.turns == 1


def test_an_interrupt_reaches_the_outer_block_that_defers_signals() -> None:
    executor = InterruptedExecutor()
    session = Session(cast("Any", None), cast("Any", executor), None)
    with deferred_signals() as received:
        assert session.wait_for(lambda: bool(received), 5.0)
    assert received == [signal.SIGINT]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
