"""Simulates a run: `start(simulation) -> state` and `step(simulation, state, commands, dt) -> state`."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sim.clearance import Clearance, Obstacles, clearance, distance_to_nearest, obstacles_around
from sim.engine.trig import wrap
from sim.exceptions import SpecError
from sim.noise import normal, words_of_ticks
from sim.pose import REST, Command, Pose
from sim.robot import RobotSpec
from sim.scene import Body
from sim.sensing import observe
from sim.state import Commands, Event, RobotState, Simulation, State

__all__ = ["Clearance", "Commands", "Event", "Simulation", "State", "clearance", "observe", "start", "step"]

Floats = NDArray[np.float64]
MAX_STEP = 3600.0
TimedCommand = tuple[Command, int]


@dataclass(slots=True)
class Run:
    """The data of one robot during a step: first the values that stay the same, then those that change."""

    spec: RobotSpec
    body: Body
    timed_command: TimedCommand
    vector: Floats
    noise: Floats
    collided: bool
    collisions: int
    name: str


def start(simulation: Simulation) -> State:
    """Return the state at time 0, with every robot at rest at its start pose and its odometry at zero."""
    start_poses = simulation.world.starts
    robots = []
    for index, spec in enumerate(simulation.robots):
        pose = spec.start or start_poses[index % len(start_poses)]
        robots.append(RobotState(name=spec.name, pose=Pose(pose.x, pose.y, wrap(pose.theta))))
    return _with_frozen_lidars(simulation, State(tick=0, time_ns=0, robots=tuple(robots)))


def step(simulation: Simulation, state: State, commands: Commands = None, dt: float | None = None) -> State:
    """Return the state `dt` seconds later, with each robot executing its command.

    Args:
        simulation: the world and its robots.
        state: the current state.
        commands: the commands by robot name, or the command of a single robot. A robot without a new one
            continues with its last command until its watchdog stops it.
        dt: the time in seconds; one physics tick if None. It is divided into ticks of the physics period, the last of
            which may be shorter. One step of five ticks and five steps of one tick have the same result.

    Raises:
        SpecError: a robot does not exist, a command is not finite, or `dt` is invalid.
    """
    if dt is None:
        dt_ns = simulation.tick_ns
    elif 0.0 < dt <= MAX_STEP:
        dt_ns = round(dt * 1e9)
    else:
        raise SpecError(f"dt is {dt!r}; give a step in seconds, above 0 and at most {MAX_STEP:.0f}")
    timed_commands = _timed_commands(simulation, state, commands)
    ticks, remainder_ns = divmod(dt_ns, simulation.tick_ns)
    events: list[Event] = []
    robots = state.robots
    time_ns = state.time_ns
    if ticks:
        robots = _advance(simulation, robots, timed_commands, state.tick, time_ns, ticks, simulation.tick_ns, events)
        time_ns += ticks * simulation.tick_ns
    if remainder_ns:
        robots = _advance(simulation, robots, timed_commands, state.tick + ticks, time_ns, 1, remainder_ns, events)
        time_ns += remainder_ns
        ticks += 1
    new_state = State(state.tick + ticks, time_ns, robots, tuple(events))
    return _with_frozen_lidars(simulation, new_state) if simulation.scene.may_freeze else new_state


def _timed_commands(simulation: Simulation, state: State, commands: Commands) -> list[TimedCommand]:
    """Return each robot's command and its time, in the robots' order."""
    timed_commands = [(robot.command, robot.command_ns) for robot in state.robots]
    if commands is None:
        return timed_commands
    if isinstance(commands, Command):
        if len(timed_commands) > 1:
            raise SpecError("one command for several robots; give a mapping from robot names to commands")
        commands = {simulation.robots[0].name: commands}
    for name, command in commands.items():
        if not (math.isfinite(command.linear) and math.isfinite(command.angular)):
            raise SpecError(f"the command for robot {name!r} is not finite: {command}; give m/s and rad/s")
        timed_commands[simulation.number_of(name)] = (command, state.time_ns)
    return timed_commands


def _advance(
    simulation: Simulation,
    robots: tuple[RobotState, ...],
    timed_commands: list[TimedCommand],
    tick: int,
    time_ns: int,
    ticks: int,
    tick_ns: int,
    events: list[Event],
) -> tuple[RobotState, ...]:
    """Advance all robots by equal ticks: all ticks at once if nothing is near any robot, otherwise one by one."""
    scene = simulation.scene
    seconds = ticks * tick_ns / 1e9
    poses = [robot.pose for robot in robots]
    runs = [
        Run(
            spec,
            body,
            timed_command,
            _vector(robot),
            _noise(body, tick, ticks),
            robot.collided,
            robot.collisions,
            robot.name,
        )
        for spec, body, timed_command, robot in zip(
            simulation.robots, scene.bodies, timed_commands, robots, strict=True
        )
    ]
    # The longest distances that robots and movers can cover in these ticks.
    strides = [
        max(body.max_linear, abs(robot.velocity.linear)) * seconds
        for body, robot in zip(scene.bodies, robots, strict=True)
    ]
    max_other_stride = max(strides) if len(robots) > 1 else 0.0
    max_other_stride = max(max_other_stride, scene.mover_speed * seconds)
    is_near = [
        distance_to_nearest(simulation, time_ns, poses, index) - run.body.reach
        <= strides[index] + max_other_stride + 1e-3
        for index, run in enumerate(runs)
    ]
    if True not in is_near:
        for run in runs:
            _advance_unobstructed(simulation, run, time_ns, ticks, tick_ns, run.noise, events)
    else:
        for number in range(ticks):
            now_ns = time_ns + number * tick_ns
            for index, run in enumerate(runs):
                noise = run.noise[number : number + 1]
                if is_near[index]:
                    other_poses = [Pose(*other.vector[:3].tolist()) for other in runs]
                    max_distance = run.body.reach + 2.0 * strides[index] + 1e-3
                    obstacles = obstacles_around(simulation, now_ns + tick_ns, other_poses, index, max_distance)
                    _advance_near_obstacles(simulation, run, now_ns, tick_ns, noise[0], obstacles, events)
                else:
                    _advance_unobstructed(simulation, run, now_ns, 1, tick_ns, noise, events)
    return tuple([_robot_state(robot, run) for robot, run in zip(robots, runs, strict=True)])


def _advance_unobstructed(
    simulation: Simulation, run: Run, time_ns: int, ticks: int, tick_ns: int, noise: Floats, events: list[Event]
) -> None:
    body, vector = run.body, run.vector
    command, command_ns = run.timed_command
    advance_unobstructed = simulation.scene.engine.advance_unobstructed
    dt = tick_ns / 1e9
    active_ticks = min(max(-((time_ns - command_ns - body.watchdog_ns) // tick_ns), 0), ticks)
    if active_ticks:
        advance_unobstructed(vector, command.linear, command.angular, active_ticks, dt, body.limits, body.drift, noise)
    if active_ticks < ticks:
        _add_watchdog_event(run, time_ns + active_ticks * tick_ns, tick_ns, events)
        advance_unobstructed(vector, 0.0, 0.0, ticks - active_ticks, dt, body.limits, body.drift, noise[active_ticks:])
    run.collided = False


def _advance_near_obstacles(
    simulation: Simulation,
    run: Run,
    time_ns: int,
    tick_ns: int,
    noise: Floats,
    obstacles: Obstacles,
    events: list[Event],
) -> None:
    body = run.body
    command, command_ns = run.timed_command
    if time_ns - command_ns >= body.watchdog_ns:
        _add_watchdog_event(run, time_ns, tick_ns, events)
        command = REST
    contact = np.zeros(6)
    is_hit = simulation.scene.engine.advance_near_obstacles(
        run.vector,
        command.linear,
        command.angular,
        tick_ns / 1e9,
        body.limits,
        body.drift,
        noise,
        body.shape,
        obstacles.walls,
        obstacles.circles,
        run.spec.on_collision == "slide",
        contact,
    )
    if is_hit and not run.collided:
        number, x, y, _, _, speed = contact.tolist()
        description = f"{run.name} met {obstacles.names[int(number)]} at {speed:.2f} m/s"
        events.append(Event(time_ns + tick_ns, run.name, "collision", description, x, y, speed))
        run.collisions += 1
    run.collided = bool(is_hit)


def _add_watchdog_event(run: Run, time_ns: int, tick_ns: int, events: list[Event]) -> None:
    """Add an event at the first tick at which a command to move has expired."""
    command, command_ns = run.timed_command
    was_active = time_ns - tick_ns - command_ns < run.body.watchdog_ns
    if was_active and (command.linear != 0.0 or command.angular != 0.0):
        x, y, _, v = run.vector[:4].tolist()
        description = f"{run.name} had no new command for {run.body.watchdog_ns / 1e9:g} s and stops"
        events.append(Event(time_ns, run.name, "watchdog", description, x, y, abs(v)))


def _noise(body: Body, tick: int, ticks: int) -> Floats:
    if body.has_drift:
        return normal(words_of_ticks(body.odometry_key, tick, ticks)[:, :2])
    return np.zeros((ticks, 2))


def _vector(robot: RobotState) -> Floats:
    pose, velocity, odometry = robot.pose, robot.velocity, robot.odometry
    xx, xy, xt, _, yy, yt, _, _, tt = robot.covariance
    return np.array(
        (
            *(pose.x, pose.y, pose.theta, velocity.linear, velocity.angular),
            *(odometry.x, odometry.y, odometry.theta, xx, xy, xt, yy, yt, tt),
        )
    )


def _robot_state(robot: RobotState, run: Run) -> RobotState:
    x, y, theta, v, w, ox, oy, ot, xx, xy, xt, yy, yt, tt = run.vector.tolist()
    return RobotState(
        run.name,
        Pose(x, y, theta),
        Command(v, w),
        run.timed_command[0],
        run.timed_command[1],
        Pose(ox, oy, ot),
        (xx, xy, xt, xy, yy, yt, xt, yt, tt),
        run.collided,
        run.collisions,
        robot.held,
    )


def _with_frozen_lidars(simulation: Simulation, state: State) -> State:
    """Store the state in which a lidar froze, for each lidar that is frozen now."""
    robots = [
        _with_frozen_lidar(spec, robot, state) for spec, robot in zip(simulation.robots, state.robots, strict=True)
    ]
    return replace(state, robots=tuple(robots))


def _with_frozen_lidar(spec: RobotSpec, robot: RobotState, state: State) -> RobotState:
    is_frozen = any(window.holds(state.time_ns) for window in spec.faults.frozen)
    if not is_frozen:
        return robot if robot.held is None else replace(robot, held=None)
    if robot.held is not None:
        return robot
    robots = tuple(replace(other, held=None) for other in state.robots)
    return replace(robot, held=replace(state, robots=robots, events=()))
