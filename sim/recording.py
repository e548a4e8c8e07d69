"""A recording of a run: arrays of its states, commands and scans, which can be saved to a file and replayed exactly."""

from __future__ import annotations

import hashlib
import json
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim.clearance import clearance
from sim.codec import from_json, to_json
from sim.engine import EngineName
from sim.exceptions import RecordingError
from sim.lidar import Scan
from sim.log import Line, Log
from sim.pose import Command
from sim.sensing import observe
from sim.simulation import start, step
from sim.state import Commands, Event, Simulation, State

FORMAT = 1
MAX_BYTES = 4_000_000_000


@dataclass(frozen=True, slots=True, eq=False)
class ScanLog:
    """The S scans of one robot.

    `rows` (S,) int64 contains each scan's row in the recording, and `stamps_ns` (S,) int64 the time of its first beam.
    `ranges` and `intensities` are (S, beams) float32, the latter (S, 0) if the lidar does not measure intensities.
    """

    rows: NDArray[np.int64]
    stamps_ns: NDArray[np.int64]
    ranges: NDArray[np.float32]
    intensities: NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """A run of R robots with K states. Row 0 is the start.

    The columns are `times_ns` (K,) int64; `poses` (K, R, 3), x, y, theta in m, m, rad, frame map; `velocities`
    (K, R, 2) in m/s, rad/s; `commands` (K, R, 2), sent before each state, nan if there was none; `odometry` (K, R, 3)
    and `covariances` (K, R, 9); `collided` (K, R) bool; `clearances` (K, R) in metres. `scans` has a log for each
    robot. `log_lines` is the output of the programs, which is not part of the hash.
    """

    simulation: Simulation
    times_ns: NDArray[np.int64]
    poses: NDArray[np.float64]
    velocities: NDArray[np.float64]
    commands: NDArray[np.float64]
    odometry: NDArray[np.float64]
    covariances: NDArray[np.float64]
    collided: NDArray[np.bool_]
    clearances: NDArray[np.float64]
    scans: tuple[ScanLog, ...]
    events: tuple[Event, ...] = ()
    log_lines: tuple[Line, ...] = ()

    def __len__(self) -> int:
        return len(self.times_ns)

    @property
    def times(self) -> NDArray[np.float64]:
        """The times in seconds, (K,)."""
        return self.times_ns / 1e9

    def sha256(self) -> str:
        """Return the hash of the exact content: simulation, times, commands, states, scans and events."""
        digest = hashlib.sha256(to_json(self.simulation).encode())
        for name, array in self._arrays().items():
            digest.update(f"{name} {array.dtype.str} {array.shape}".encode())
            digest.update(np.ascontiguousarray(array).tobytes())
        digest.update(json.dumps([asdict(event) for event in self.events]).encode())
        return digest.hexdigest()

    def save(self, path: str | Path) -> None:
        """Write the recording to a compressed file, usually named `.npz`."""
        header = {
            "format": FORMAT,
            "simulation": to_json(self.simulation),
            "events": [asdict(event) for event in self.events],
            "said": self.log_lines,
        }
        text = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
        arrays: dict[str, Any] = {"header": text, **self._arrays()}
        with Path(path).open("wb") as file:
            np.savez_compressed(file, **arrays)

    def _arrays(self) -> dict[str, NDArray[Any]]:
        arrays: dict[str, NDArray[Any]] = {name: getattr(self, name) for name in _COLUMNS}
        for index, log in enumerate(self.scans):
            arrays |= {f"scan{index}_{name}": getattr(log, name) for name in _SCAN_COLUMNS}
        return arrays


# The exceptions that numpy, zipfile, zlib and json raise for a file that is damaged or not a recording.
_READ_ERRORS = (
    OSError,
    LookupError,
    TypeError,
    ValueError,
    AttributeError,
    EOFError,
    NotImplementedError,
    RuntimeError,
    SyntaxError,
    MemoryError,
    OverflowError,
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    tokenize.TokenError,
)
_COLUMNS = ("times_ns", "poses", "velocities", "commands", "odometry", "covariances", "collided", "clearances")
_SCAN_COLUMNS = ("rows", "stamps_ns", "ranges", "intensities")


class Recorder:
    """Collects the states of a run, and in `log` the output of programs. `recording()` returns them."""

    def __init__(self, simulation: Simulation, state: State | None = None) -> None:
        self._simulation = simulation
        self._names = [spec.name for spec in simulation.robots]
        self._states: list[State] = []
        self._commands: list[list[tuple[float, float]]] = []
        self._scans: list[list[tuple[int, Scan]]] = [[] for _ in self._names]
        self._clearances: list[list[float]] = []
        self.log = Log()
        self.append(start(simulation) if state is None else state)

    def append(self, state: State, commands: Commands = None) -> None:
        """Add a state, and the commands of the step that led to it."""
        commands_by_robot = {self._names[0]: commands} if isinstance(commands, Command) else commands or {}
        self._states.append(state)
        self._commands.append(
            [
                (commands_by_robot[name].linear, commands_by_robot[name].angular)
                if name in commands_by_robot
                else (np.nan, np.nan)
                for name in self._names
            ]
        )
        self._clearances.append([clearance(self._simulation, state, name).distance for name in self._names])

    def scan(self, scan: Scan | None, robot: str | None = None) -> None:
        """Add a scan measured in the last state that was added. None, from a dead lidar, is ignored."""
        if scan is not None:
            self._scans[0 if robot is None else self._names.index(robot)].append((len(self._states) - 1, scan))

    def recording(self) -> Recording:
        """Return a recording of the states that have been added."""
        states, count = self._states, len(self._names)

        def table(rows: list[Any], width: int) -> NDArray[np.float64]:
            return np.array(rows, dtype=np.float64).reshape(len(states), count, width)

        robots = [state.robots for state in states]
        return Recording(
            simulation=self._simulation,
            times_ns=np.array([state.time_ns for state in states], dtype=np.int64),
            poses=table([[(r.pose.x, r.pose.y, r.pose.theta) for r in row] for row in robots], 3),
            velocities=table([[(r.velocity.linear, r.velocity.angular) for r in row] for row in robots], 2),
            commands=table(self._commands, 2),
            odometry=table([[(r.odometry.x, r.odometry.y, r.odometry.theta) for r in row] for row in robots], 3),
            covariances=table([[r.covariance for r in row] for row in robots], 9),
            collided=np.array([[r.collided for r in row] for row in robots], dtype=np.bool_),
            clearances=np.array(self._clearances, dtype=np.float64),
            scans=tuple(_log(scans) for scans in self._scans),
            events=tuple(event for state in states for event in state.events),
            log_lines=self.log.lines(),
        )


def _log(scans: list[tuple[int, Scan]]) -> ScanLog:
    ranges = [scan.ranges for _, scan in scans]
    intensities = [scan.intensities for _, scan in scans]
    return ScanLog(
        rows=np.array([row for row, _ in scans], dtype=np.int64),
        stamps_ns=np.array([scan.stamp_ns for _, scan in scans], dtype=np.int64),
        ranges=np.array(ranges, dtype=np.float32) if scans else np.empty((0, 0), np.float32),
        intensities=np.array(intensities, dtype=np.float32) if scans else np.empty((0, 0), np.float32),
    )


def run(
    simulation: Simulation,
    policy: Callable[[State, dict[str, Scan | None]], Commands],
    seconds: float,
    *,
    dt: float = 0.1,
) -> Recording:
    """Simulate a run, and record it.

    Args:
        simulation: the world and its robots.
        policy: returns the commands for the next `dt`, given the state and each robot's scan.
        seconds: the duration in simulated time.
        dt: the simulated time between two scans, in seconds.
    """
    state = start(simulation)
    recorder = Recorder(simulation, state)
    for _ in range(round(seconds / dt)):
        scans = {}
        for spec in simulation.robots:
            if spec.lidar is not None:
                scans[spec.name] = observe(simulation, state, spec.name)
                recorder.scan(scans[spec.name], spec.name)
        commands = policy(state, scans)
        state = step(simulation, state, commands, dt)
        recorder.append(state, commands)
    return recorder.recording()


def load_recording(path: str | Path) -> Recording:
    """Read a recording from a file. Raise a RecordingError if the file is damaged or not a recording."""
    try:
        with Path(path).open("rb") as stream, zipfile.ZipFile(stream) as archive:
            size = sum(part.file_size for part in archive.infolist())
        if size > MAX_BYTES:
            raise RecordingError(f"{path}: {size} bytes when unpacked; a recording holds at most {MAX_BYTES}")
        with Path(path).open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            header = json.loads(file["header"].tobytes())
            if header["format"] != FORMAT:
                raise RecordingError(
                    f"{path}: format {header['format']} is not the format {FORMAT} that this version reads; "
                    "record the run again"
                )
            simulation = from_json(header["simulation"])
            columns = {name: file[name] for name in _COLUMNS}
            logs = [
                {name: file[f"scan{index}_{name}"] for name in _SCAN_COLUMNS} for index in range(len(simulation.robots))
            ]
        _check_columns(columns, logs)
        events = tuple(Event(**event) for event in header["events"])
        log_lines = tuple((float(seconds), str(text)) for seconds, text in header.get("said", ()))
        scans = tuple(ScanLog(**log) for log in logs)
        return Recording(simulation, **columns, scans=scans, events=events, log_lines=log_lines)
    except FileNotFoundError:
        raise RecordingError(f"{path}: there is no such file; give the path of a saved recording") from None
    except RecordingError as error:
        raise RecordingError(str(error) if str(path) in str(error) else f"{path}: {error}") from None
    except _READ_ERRORS as error:
        raise RecordingError(f"{path}: not a recording, or a damaged one ({error}); record the run again") from None


def _check_columns(columns: dict[str, NDArray[Any]], logs: list[dict[str, NDArray[Any]]]) -> None:
    """Raise a RecordingError unless the columns can belong to one run."""
    rows, robots = len(columns["times_ns"]), len(logs)
    expected_columns: dict[str, tuple[NDArray[Any], str, tuple[int, ...]]] = {
        "times_ns": (columns["times_ns"], "i8", (rows,)),
        "collided": (columns["collided"], "b1", (rows, robots)),
        "clearances": (columns["clearances"], "f8", (rows, robots)),
    }
    for name, width in (("poses", 3), ("velocities", 2), ("commands", 2), ("odometry", 3), ("covariances", 9)):
        expected_columns[name] = (columns[name], "f8", (rows, robots, width))
    for index, log in enumerate(logs):
        count = len(log["rows"])
        expected_columns[f"scan{index}_rows"] = (log["rows"], "i8", (count,))
        expected_columns[f"scan{index}_stamps_ns"] = (log["stamps_ns"], "i8", (count,))
        for name in ("ranges", "intensities"):
            expected_columns[f"scan{index}_{name}"] = (log[name], "f4", (count, *log[name].shape[1:2]))
    for name, (array, kind, shape) in expected_columns.items():
        if array.dtype != np.dtype(kind) or array.shape != shape or array.ndim != len(shape):
            raise RecordingError(
                f"the column {name} has the shape {array.shape} of {array.dtype}, not {shape} of {np.dtype(kind)}; "
                "record the run again"
            )


def replay(recording: Recording, *, engine: EngineName = "numpy") -> Iterator[State]:
    """Run the recorded commands again from the start. Each state equals the recorded one, bit for bit.

    Raises a RecordingError if the recording does not begin at the start of its run.
    """
    if recording.times_ns[0] != 0:
        raise RecordingError("the recording begins in the middle of its run; record from `start` on to replay it")
    simulation = replace(recording.simulation, engine=engine)
    state = start(simulation)
    yield state
    for row in range(1, len(recording)):
        commands = {
            spec.name: Command(*recording.commands[row, index].tolist())
            for index, spec in enumerate(simulation.robots)
            if not np.isnan(recording.commands[row, index, 0])
        }
        dt_ns = int(recording.times_ns[row] - recording.times_ns[row - 1])
        state = step(simulation, state, commands, dt_ns / 1e9)
        yield state
