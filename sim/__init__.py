"""A 2D lidar simulator. Pure functions move robots through a world of walls, and compute exact scans.

>>> from sim import Command, Simulation, World, box, observe, start, step
>>> simulation = Simulation(World.from_segments(box(4.0, 3.0)))
>>> state = step(simulation, start(simulation), Command(linear=0.2), dt=0.1)
>>> observe(simulation, state).ranges[0]
"""

from sim.clearance import Clearance, clearance
from sim.exceptions import EngineError, RecordingError, SimError, SpecError, WorldError
from sim.faults import DeadSector, Faults, Window
from sim.lidar import LDS_01, RPLIDAR_A1, UTM_30LX, LidarSpec, Scan
from sim.pose import Command, Pose
from sim.recording import Recorder, Recording, ScanLog, load_recording, replay, run
from sim.robot import OdometryDrift, RobotSpec
from sim.sensing import cast, directions, observe, scan_angles
from sim.simulation import start, step
from sim.state import Event, RobotState, Simulation, State
from sim.world import BOX_NAMES, Goal, Mover, World, box
from sim.worldfile import load_world

__all__ = [
    "BOX_NAMES",
    "LDS_01",
    "RPLIDAR_A1",
    "UTM_30LX",
    "Clearance",
    "Command",
    "DeadSector",
    "EngineError",
    "Event",
    "Faults",
    "Goal",
    "LidarSpec",
    "Mover",
    "OdometryDrift",
    "Pose",
    "Recorder",
    "Recording",
    "RecordingError",
    "RobotSpec",
    "RobotState",
    "Scan",
    "ScanLog",
    "SimError",
    "Simulation",
    "SpecError",
    "State",
    "Window",
    "World",
    "WorldError",
    "box",
    "cast",
    "clearance",
    "directions",
    "load_recording",
    "load_world",
    "observe",
    "replay",
    "run",
    "scan_angles",
    "start",
    "step",
]
