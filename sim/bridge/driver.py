"""Steps a simulation for the ROS node, and determines what to send after each tick, without importing ROS."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sim.lidar import Scan
from sim.pose import Command, Pose
from sim.rates import due
from sim.simulation import Simulation, State, observe, start, step


@dataclass(frozen=True)
class TickOutput:
    """The output of one tick: the state, the names of the robots that send odometry, and scans by robot name."""

    state: State
    odometry: tuple[str, ...]
    scans: dict[str, Scan]


class Driver:
    """Keeps the state of a run, and the commands received since the last tick.

    A command is passed to the core once, at the next tick. From then on, the robot's watchdog counts simulated time.
    `newest_scans` contains each robot's last scan, and the robot's pose at that scan.
    """

    def __init__(self, simulation: Simulation, *, odometry_rate: float = 50.0) -> None:
        self.simulation = simulation
        self._odometry_rate = odometry_rate
        self.reset()

    def warm_up(self) -> None:
        """Scan and step once, and discard the results, so that an engine is compiled before time starts."""
        state = step(self.simulation, start(self.simulation))
        for spec in self.simulation.robots:
            if spec.lidar is not None:
                observe(self.simulation, state, spec.name)

    @property
    def state(self) -> State:
        """The current state of the run."""
        return self._state

    def reset(self) -> None:
        """Return to the start, and drop commands that have not been executed."""
        self._state = start(self.simulation)
        self._pending_commands: dict[str, Command] = {}
        self.newest_scans: dict[str, tuple[Scan, Pose]] = {}

    def command(self, robot: str, command: Command) -> None:
        """Store a command for `robot` until the next tick. A newer one replaces it."""
        self._pending_commands[robot] = command

    def ticks(self, seconds: float) -> int:
        """Return the number of whole ticks in `seconds` of simulated time."""
        return int(seconds / self.simulation.tick + 1e-9)

    def run(self, ticks: int) -> Iterator[TickOutput]:
        """Simulate `ticks` ticks, and yield the output of each."""
        for _ in range(ticks):
            before_ns = self._state.time_ns
            commands, self._pending_commands = self._pending_commands, {}
            self._state = step(self.simulation, self._state, commands)
            yield self._output(before_ns)

    def _output(self, before_ns: int) -> TickOutput:
        state = self._state
        scans = {}
        for index, spec in enumerate(self.simulation.robots):
            if spec.lidar is not None and due(before_ns, state.time_ns, spec.lidar.rate):
                scan = observe(self.simulation, state, spec.name)
                if scan is not None:
                    scans[spec.name] = scan
                    self.newest_scans[spec.name] = (scan, state.robots[index].pose)
        names = tuple(spec.name for spec in self.simulation.robots)
        sends_odometry = due(before_ns, state.time_ns, self._odometry_rate)
        return TickOutput(state, names if sends_odometry else (), scans)
