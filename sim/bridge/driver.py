"""Steps a simulation for the ROS node, and says what is due to be sent after each tick. It imports no ROS."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sim.lidar import Scan
from sim.pose import Command, Pose
from sim.rates import due
from sim.simulation import Simulation, State, observe, start, step


@dataclass(frozen=True)
class Sent:
    """What is sent after one tick: the state for the clock, and by robot name who sends odometry and which scan."""

    state: State
    odometry: tuple[str, ...]
    scans: dict[str, Scan]


class Driver:
    """Holds the state of a run, and the commands that have come in since the last tick.

    A command is handed to the core once, at the tick after it came: the robot's watchdog counts simulated time from
    there. `newest` holds each robot's last scan, and the pose it was taken from.
    """

    def __init__(self, simulation: Simulation, *, odometry_rate: float = 50.0) -> None:
        self.simulation = simulation
        self._odometry_rate = odometry_rate
        self.reset()

    def warm_up(self) -> None:
        """Scan and step once without keeping anything: a compiling engine compiles before time starts."""
        state = step(self.simulation, start(self.simulation))
        for spec in self.simulation.robots:
            if spec.lidar is not None:
                observe(self.simulation, state, spec.name)

    @property
    def state(self) -> State:
        """The run as it is now."""
        return self._state

    def reset(self) -> None:
        """Go back to the start; commands that have not been obeyed yet are forgotten."""
        self._state = start(self.simulation)
        self._pending: dict[str, Command] = {}
        self.newest: dict[str, tuple[Scan, Pose]] = {}

    def command(self, robot: str, command: Command) -> None:
        """Take a command for `robot`; a newer one before the next tick replaces it."""
        self._pending[robot] = command

    def ticks(self, seconds: float) -> int:
        """Return how many whole ticks there are in `seconds` of simulated time."""
        return int(seconds / self.simulation.tick + 1e-9)

    def run(self, ticks: int) -> Iterator[Sent]:
        """Go on by so many ticks, and yield what is due after each."""
        for _ in range(ticks):
            before = self._state.time_ns
            commands, self._pending = self._pending, {}
            self._state = step(self.simulation, self._state, commands)
            yield self._due(before)

    def _due(self, before_ns: int) -> Sent:
        state = self._state
        scans = {}
        for index, spec in enumerate(self.simulation.robots):
            if spec.lidar is not None and due(before_ns, state.time_ns, spec.lidar.rate):
                scan = observe(self.simulation, state, spec.name)
                if scan is not None:
                    scans[spec.name] = scan
                    self.newest[spec.name] = (scan, state.robots[index].pose)
        names = tuple(spec.name for spec in self.simulation.robots)
        wanted = due(before_ns, state.time_ns, self._odometry_rate)
        return Sent(state, names if wanted else (), scans)
