"""The run: `start(simulation) -> state` and `step(simulation, state, commands, dt) -> state`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sim.clearance import Around, Clearance, around, clearance, nearest_of
from sim.engine.motion import STATE
from sim.engine.trig import wrap
from sim.exceptions import SpecError
from sim.noise import normal, words_of_ticks
from sim.pose import Command, Pose
from sim.robot import RobotSpec, RobotState
from sim.scene import Body
from sim.sensing import observe
from sim.state import Commands, Event, Simulation, State

__all__ = ["Clearance", "Commands", "Event", "Simulation", "State", "clearance", "observe", "start", "step"]

Floats = NDArray[np.float64]
LONGEST_STEP = 3600.0


def start(simulation: Simulation) -> State:
    """Return the state at time 0, every robot at rest on its start pose and its odometry at zero."""
    places = simulation.world.starts
    robots = []
    for index, spec in enumerate(simulation.robots):
        pose = spec.start or places[index % len(places)]
        robots.append(RobotState(name=spec.name, pose=Pose(pose.x, pose.y, wrap(pose.theta))))
    return _holding(simulation, State(tick=0, time_ns=0, robots=tuple(robots)), None)


def step(simulation: Simulation, state: State, commands: Commands = None, dt: float | None = None) -> State:
    """Return the state `dt` seconds later (one physics tick if None), each robot obeying its command.

    `commands` maps a robot's name to its command; with one robot the command alone will do. A robot that is not
    named keeps its last command until its watchdog stops it. `dt` is cut into ticks of the physics period, the last
    one shorter where it must be: one step of five ticks and five steps of one tick end in the same state.

    Raises SpecError for a robot that does not exist, a command that is not finite, or a `dt` that makes no sense.
    """
    tick_ns = simulation.tick_ns
    if dt is None:
        dt_ns = tick_ns
    elif 0.0 < dt <= LONGEST_STEP:
        dt_ns = round(dt * 1e9)
    else:
        raise SpecError(f"dt is {dt!r}; give a step in seconds, above 0 and at most {LONGEST_STEP:.0f}")
    ticks, rest_ns = divmod(dt_ns, tick_ns)
    time_ns = state.time_ns
    robots = state.robots
    if commands is not None:
        robots = _commanded(simulation, state, commands)
    events: list[Event] = []
    tick = state.tick
    if ticks:
        robots = _advance(simulation, robots, tick, time_ns, ticks, tick_ns, events)
        tick += ticks
        time_ns += ticks * tick_ns
    if rest_ns:
        robots = _advance(simulation, robots, tick, time_ns, 1, rest_ns, events)
        tick += 1
        time_ns += rest_ns
    return _holding(simulation, State(tick, time_ns, robots, tuple(events)), state)


def _commanded(simulation: Simulation, state: State, commands: Commands) -> tuple[RobotState, ...]:
    if isinstance(commands, Command):
        if len(state.robots) > 1:
            raise SpecError("one command for several robots; give a mapping from robot names to commands")
        commands = {state.robots[0].name: commands}
    assert isinstance(commands, Mapping)
    robots = list(state.robots)
    for name, command in commands.items():
        if not (math.isfinite(command.linear) and math.isfinite(command.angular)):
            raise SpecError(f"the command for robot {name!r} is not finite: {command}; give m/s and rad/s")
        index = simulation.number_of(name)
        robots[index] = replace(robots[index], command=command, command_ns=state.time_ns)
    return tuple(robots)


def _advance(
    simulation: Simulation,
    robots: tuple[RobotState, ...],
    tick: int,
    time_ns: int,
    ticks: int,
    tick_ns: int,
    events: list[Event],
) -> tuple[RobotState, ...]:
    """Advance all robots by equal ticks: at once where nothing is near any of them, else tick by tick."""
    scene = simulation.scene
    vectors = [_vector(robot) for robot in robots]
    noises = [_noise(body, tick, ticks) for body in scene.bodies]
    seconds = ticks * tick_ns / 1e9
    strides = [
        max(spec.max_linear, abs(robot.velocity.linear)) * seconds
        for spec, robot in zip(simulation.robots, robots, strict=True)
    ]
    poses = [robot.pose for robot in robots]
    mover_stride = max((mover.speed for mover in simulation.world.movers), default=0.0) * seconds
    others = max(strides, default=0.0) if len(robots) > 1 else 0.0
    near = [
        nearest_of(simulation, time_ns, poses, index) - body.reach <= stride + max(mover_stride, others) + 1e-3
        for index, (body, stride) in enumerate(zip(scene.bodies, strides, strict=True))
    ]
    flags = [(robot.collided, robot.collisions) for robot in robots]
    if not any(near):
        for index, (robot, body) in enumerate(zip(robots, scene.bodies, strict=True)):
            _coast(simulation, robot, body, vectors[index], time_ns, ticks, tick_ns, noises[index], events)
        flags = [(False, collisions) for _, collisions in flags]
    else:
        for number in range(ticks):
            now_ns = time_ns + number * tick_ns
            for index, (robot, body) in enumerate(zip(robots, scene.bodies, strict=True)):
                one = noises[index][number : number + 1]
                here = [Pose(*vector[:3].tolist()) for vector in vectors]
                if near[index]:
                    within = body.reach + 2.0 * strides[index] + 1e-3
                    things = around(simulation, now_ns + tick_ns, here, index, within)
                    flags[index] = _push(
                        simulation, index, robot, vectors[index], now_ns, tick_ns, one[0], things, flags[index], events
                    )
                else:
                    _coast(simulation, robot, body, vectors[index], now_ns, 1, tick_ns, one, events)
                    flags[index] = (False, flags[index][1])
    return tuple(_unpacked(robot, vector, *flag) for robot, vector, flag in zip(robots, vectors, flags, strict=True))


def _coast(
    simulation: Simulation,
    robot: RobotState,
    body: Body,
    vector: Floats,
    time_ns: int,
    ticks: int,
    tick_ns: int,
    noise: Floats,
    events: list[Event],
) -> None:
    coast = simulation.scene.engine.coast
    dt = tick_ns / 1e9
    left_ns = robot.command_ns + body.watchdog_ns - time_ns
    obeyed = min(max(-(-left_ns // tick_ns), 0), ticks)
    if obeyed:
        command = robot.command
        coast(vector, command.linear, command.angular, obeyed, dt, body.limits, body.drift, noise)
    if obeyed < ticks:
        _tell_watchdog(robot, vector, time_ns + obeyed * tick_ns, tick_ns, body, events)
        coast(vector, 0.0, 0.0, ticks - obeyed, dt, body.limits, body.drift, noise[obeyed:])


def _push(
    simulation: Simulation,
    index: int,
    robot: RobotState,
    vector: Floats,
    time_ns: int,
    tick_ns: int,
    noise: Floats,
    things: Around,
    flag: tuple[bool, int],
    events: list[Event],
) -> tuple[bool, int]:
    spec, body = simulation.robots[index], simulation.scene.bodies[index]
    command = robot.command
    if time_ns - robot.command_ns >= body.watchdog_ns:
        _tell_watchdog(robot, vector, time_ns, tick_ns, body, events)
        command = Command()
    touch = np.zeros(6)
    hit = simulation.scene.engine.push(
        vector,
        command.linear,
        command.angular,
        tick_ns / 1e9,
        body.limits,
        body.drift,
        noise,
        body.shape,
        things.walls,
        things.circles,
        spec.on_collision == "slide",
        touch,
    )
    collided, collisions = flag
    if hit and not collided:
        what, speed = things.names[int(touch[0])], float(touch[5])
        events.append(
            Event(
                time_ns + tick_ns,
                spec.name,
                "collision",
                f"{spec.name} met {what} at {speed:.2f} m/s",
                float(touch[1]),
                float(touch[2]),
                speed,
            )
        )
        collisions += 1
    return bool(hit), collisions


def _tell_watchdog(
    robot: RobotState, vector: Floats, time_ns: int, tick_ns: int, body: Body, events: list[Event]
) -> None:
    """Note the first tick at which a command that asks for motion is dropped for its age."""
    fresh = time_ns - tick_ns - robot.command_ns < body.watchdog_ns
    if fresh and (robot.command.linear != 0.0 or robot.command.angular != 0.0):
        x, y = vector[:2].tolist()
        what = f"{robot.name} had no new command for {body.watchdog_ns / 1e9:g} s and stops"
        events.append(Event(time_ns, robot.name, "watchdog", what, x, y, abs(float(vector[3]))))


def _noise(body: Body, tick: int, ticks: int) -> Floats:
    if body.drift.any():
        return normal(words_of_ticks(body.odometry_key, tick, ticks)[:, :2])
    return np.zeros((ticks, 2))


def _vector(robot: RobotState) -> Floats:
    pose, velocity, odometry, c = robot.pose, robot.velocity, robot.odometry, robot.covariance
    vector = np.array(
        (
            pose.x,
            pose.y,
            pose.theta,
            velocity.linear,
            velocity.angular,
            odometry.x,
            odometry.y,
            odometry.theta,
            c[0],
            c[1],
            c[2],
            c[4],
            c[5],
            c[8],
        )
    )
    assert len(vector) == STATE
    return vector


def _unpacked(robot: RobotState, vector: Floats, collided: bool, collisions: int) -> RobotState:
    x, y, theta, v, w, ox, oy, ot, xx, xy, xt, yy, yt, tt = vector.tolist()
    return RobotState(
        robot.name,
        Pose(x, y, theta),
        Command(v, w),
        robot.command,
        robot.command_ns,
        Pose(ox, oy, ot),
        (xx, xy, xt, xy, yy, yt, xt, yt, tt),
        collided,
        collisions,
        robot.held,
    )


def _holding(simulation: Simulation, state: State, before: State | None) -> State:
    """Keep, for each lidar that is frozen now, the state that it froze in."""
    if not any(spec.faults.frozen for spec in simulation.robots):
        return state
    robots = [_held(spec, robot, state) for spec, robot in zip(simulation.robots, state.robots, strict=True)]
    return replace(state, robots=tuple(robots))


def _held(spec: RobotSpec, robot: RobotState, state: State) -> RobotState:
    frozen = any(window.holds(state.time_ns) for window in spec.faults.frozen)
    if not frozen:
        return robot if robot.held is None else replace(robot, held=None)
    if robot.held is not None:
        return robot
    seen = tuple(replace(other, held=None) for other in state.robots)
    return replace(robot, held=replace(state, robots=seen, events=()))
