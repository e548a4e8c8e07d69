"""The run behind the node, without ROS, and the node in a thread beside a notebook."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path

import pytest
import rclpy

from sim import Command, LidarSpec, RobotSpec, Simulation, SpecError, World, WorldError, start, step
from sim.bridge import Bridge
from sim.bridge.driver import Driver
from sim.rates import due
from sim.view import LiveView, live

ROOT = Path(__file__).resolve().parents[3]
LAB = ROOT / "assets" / "worlds" / "lab.yaml"
PATIENCE = 60.0


def test_scans_and_odometry_have_their_mean_rates_for_any_tick() -> None:
    simulation = Simulation(World(), robots=(RobotSpec(lidar=LidarSpec(rate=5.5)),), tick=0.03)
    driver = Driver(simulation, odometry_rate=20.0)
    outputs = list(driver.run(driver.ticks(60.0)))
    assert sum(len(output.scans) for output in outputs) == 330
    assert sum(len(output.odometry) for output in outputs) == 1200
    assert [output.state.tick for output in outputs] == list(range(1, 2001))


def test_a_command_is_applied_once_and_the_watchdog_counts_from_there() -> None:
    driver = Driver(Simulation(World()))
    driver.command("robot", Command(9.0, 0.0))
    driver.command("robot", Command(0.2, 0.0))
    states = [output.state for output in driver.run(50)]
    expected = step(driver.simulation, start(driver.simulation), Command(0.2, 0.0))
    assert states[0] == expected
    assert states[-1].robots[0].velocity.linear == 0.0
    assert states[20].robots[0].velocity.linear == pytest.approx(0.2)


def test_reset_discards_pending_commands() -> None:
    driver = Driver(Simulation(World()))
    driver.command("robot", Command(0.2, 0.0))
    driver.reset()
    (output,) = driver.run(1)
    assert output.state.robots[0].command == Command()


def test_the_same_commands_give_the_same_run_in_steps_of_any_length() -> None:
    simulation = Simulation(World(), seed=3)
    at_once, in_pieces = Driver(simulation), Driver(simulation)
    for driver in (at_once, in_pieces):
        driver.command("robot", Command(0.2, 0.3))
    states = [output.state for output in at_once.run(40)]
    assert [output.state for count in (1, 19, 20) for output in in_pieces.run(count)] == states


def test_due_is_true_once_in_each_period() -> None:
    instants = list(range(0, 2_000_000_001, 30_000_000))
    due_steps = [due(before, now, 10.0) for before, now in pairwise(instants)]
    assert sum(due_steps) == 19
    assert not due(0, 99_999_999, 10.0)
    assert due(0, 100_000_000, 10.0)


@pytest.fixture
def bridge(ros_domain: int) -> Iterator[Bridge]:
    with Bridge(LAB, domain_id=ros_domain, engine="numpy", speed=5.0) as bridge:
        yield bridge


def wait_until(condition: Callable[[], bool], bridge: Bridge) -> None:
    """Wait until the bridge's thread fulfils the condition."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, "the condition never held"
        bridge.resume()  # returns when the thread answers, so no sleep is needed


def test_the_bridge_runs_pauses_steps_and_resets(bridge: Bridge) -> None:
    wait_until(lambda: bridge.driver.state.time_ns > 1_000_000_000, bridge)
    bridge.pause()
    paused = bridge.driver.state.time_ns
    bridge.step(0.5)
    assert bridge.driver.state.time_ns == paused + 500_000_000
    assert bridge.paused
    bridge.reset()
    assert bridge.driver.state.time_ns == 0


def test_a_bridge_does_not_use_the_default_rclpy_context(bridge: Bridge) -> None:
    assert bridge.running
    assert not rclpy.ok()
    rclpy.init()
    rclpy.shutdown()
    assert bridge.running


def test_a_stopped_bridge_raises_a_clear_error(bridge: Bridge) -> None:
    bridge.stop()
    bridge.stop()
    assert not bridge.running
    with pytest.raises(RuntimeError, match="the simulator has been stopped"):
        bridge.reset()


def test_the_live_view_shows_and_drives_the_robot_of_the_bridge(
    bridge: Bridge, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("AUTOGRADER_GRADING", raising=False)

    async def watch() -> LiveView:
        view = live(bridge)
        assert isinstance(view, LiveView)
        view.drive(Command(0.3, 0.0))
        deadline = time.monotonic() + PATIENCE
        while view.recording.poses[-1, 0, 0] < 1.8:
            assert time.monotonic() < deadline
            await asyncio.sleep(0.01)
        view.pause()
        return view

    with ThreadPoolExecutor(1) as thread:  # other tests may have left a loop running in this thread
        view = thread.submit(asyncio.run, watch()).result()
    assert bridge.paused
    before = view.time
    view.step(0.1)
    assert view.time == pytest.approx(before + 0.1, abs=1e-6)
    view.reset()
    assert view.time == 0.0


def test_a_view_may_be_opened_long_after_the_bridge(bridge: Bridge, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("AUTOGRADER_GRADING", raising=False)
    bridge.step(0.5)
    view = live(bridge, play=False)
    assert isinstance(view, LiveView)
    assert view.recording.times_ns.tolist() == [bridge.driver.state.time_ns]
    view.step(0.1)
    assert view.time == pytest.approx(bridge.driver.state.time_ns / 1e9)


def test_invalid_settings_leave_nothing_behind(ros_domain: int) -> None:
    with pytest.raises(WorldError, match="nowhere"):
        Bridge("nowhere.yaml", domain_id=ros_domain)
    with pytest.raises(SpecError, match="choose one of lds_01"):
        Bridge(LAB, domain_id=ros_domain, lidar="sonar")
    with pytest.raises(SpecError, match="no setting 'sped'"):
        Bridge(LAB, domain_id=ros_domain, sped=2.0)
