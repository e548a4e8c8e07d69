"""The run: `start(simulation) -> state` and `step(simulation, state, commands, dt) -> state`."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sim.clearance import Around, Clearance, around, clearance, nearest_of
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
LONGEST_STEP = 3600.0
Order = tuple[Command, int]


@dataclass(slots=True)
class Run:
    """One robot while it is being advanced: what does not change, then what does."""

    spec: RobotSpec
    body: Body
    order: Order
    vector: Floats
    noise: Floats
    collided: bool
    collisions: int
    name: str


def start(simulation: Simulation) -> State:
    """Return the state at time 0, every robot at rest on its start pose and its odometry at zero."""
    places = simulation.world.starts
    robots = []
    for index, spec in enumerate(simulation.robots):
        pose = spec.start or places[index % len(places)]
        robots.append(RobotState(name=spec.name, pose=Pose(pose.x, pose.y, wrap(pose.theta))))
    return _holding(simulation, State(tick=0, time_ns=0, robots=tuple(robots)))


def step(simulation: Simulation, state: State, commands: Commands = None, dt: float | None = None) -> State:
    """Return the state `dt` seconds later, each robot obeying its command.

    Args:
        simulation: the world and its robots.
        state: the present one.
        commands: a robot's command by its name; with one robot the command alone will do. A robot that is not named
            keeps its last command until its watchdog stops it.
        dt: in seconds; one physics tick if None. It is cut into ticks of the physics period, the last one shorter where
            it must be: one step of five ticks and five steps of one tick end in the same state.

    Raises:
        SpecError: a robot does not exist, a command is not finite, or `dt` makes no sense.
    """
    if dt is None:
        dt_ns = simulation.tick_ns
    elif 0.0 < dt <= LONGEST_STEP:
        dt_ns = round(dt * 1e9)
    else:
        raise SpecError(f"dt is {dt!r}; give a step in seconds, above 0 and at most {LONGEST_STEP:.0f}")
    orders = _orders(simulation, state, commands)
    ticks, rest_ns = divmod(dt_ns, simulation.tick_ns)
    events: list[Event] = []
    robots = state.robots
    time_ns = state.time_ns
    if ticks:
        robots = _advance(simulation, robots, orders, state.tick, time_ns, ticks, simulation.tick_ns, events)
        time_ns += ticks * simulation.tick_ns
    if rest_ns:
        robots = _advance(simulation, robots, orders, state.tick + ticks, time_ns, 1, rest_ns, events)
        time_ns += rest_ns
        ticks += 1
    after = State(state.tick + ticks, time_ns, robots, tuple(events))
    return _holding(simulation, after) if simulation.scene.may_freeze else after


def _orders(simulation: Simulation, state: State, commands: Commands) -> list[Order]:
    """Return each robot's command and the time it was given, in the robots' order."""
    orders = [(robot.command, robot.command_ns) for robot in state.robots]
    if commands is None:
        return orders
    if isinstance(commands, Command):
        if len(orders) > 1:
            raise SpecError("one command for several robots; give a mapping from robot names to commands")
        commands = {simulation.robots[0].name: commands}
    for name, command in commands.items():
        if not (math.isfinite(command.linear) and math.isfinite(command.angular)):
            raise SpecError(f"the command for robot {name!r} is not finite: {command}; give m/s and rad/s")
        orders[simulation.number_of(name)] = (command, state.time_ns)
    return orders


def _advance(
    simulation: Simulation,
    robots: tuple[RobotState, ...],
    orders: list[Order],
    tick: int,
    time_ns: int,
    ticks: int,
    tick_ns: int,
    events: list[Event],
) -> tuple[RobotState, ...]:
    """Advance all robots by equal ticks: at once where nothing is near any of them, else tick by tick."""
    scene = simulation.scene
    seconds = ticks * tick_ns / 1e9
    poses = [robot.pose for robot in robots]
    runs = [
        Run(spec, body, order, _vector(robot), _noise(body, tick, ticks), robot.collided, robot.collisions, robot.name)
        for spec, body, order, robot in zip(simulation.robots, scene.bodies, orders, robots, strict=True)
    ]
    # how far anything may come towards a robot meanwhile
    strides = [
        max(body.most_linear, abs(robot.velocity.linear)) * seconds
        for body, robot in zip(scene.bodies, robots, strict=True)
    ]
    theirs = max(strides) if len(robots) > 1 else 0.0
    theirs = max(theirs, scene.mover_speed * seconds)
    near = [
        nearest_of(simulation, time_ns, poses, index) - run.body.reach <= strides[index] + theirs + 1e-3
        for index, run in enumerate(runs)
    ]
    if True not in near:
        for run in runs:
            _advance_free(simulation, run, time_ns, ticks, tick_ns, run.noise, events)
    else:
        for number in range(ticks):
            now_ns = time_ns + number * tick_ns
            for index, run in enumerate(runs):
                noise = run.noise[number : number + 1]
                if near[index]:
                    here = [Pose(*other.vector[:3].tolist()) for other in runs]
                    within = run.body.reach + 2.0 * strides[index] + 1e-3
                    things = around(simulation, now_ns + tick_ns, here, index, within)
                    _advance_near(simulation, run, now_ns, tick_ns, noise[0], things, events)
                else:
                    _advance_free(simulation, run, now_ns, 1, tick_ns, noise, events)
    return tuple([_unpacked(robot, run) for robot, run in zip(robots, runs, strict=True)])


def _advance_free(
    simulation: Simulation, run: Run, time_ns: int, ticks: int, tick_ns: int, noise: Floats, events: list[Event]
) -> None:
    body, vector = run.body, run.vector
    command, command_ns = run.order
    advance_free = simulation.scene.engine.advance_free
    dt = tick_ns / 1e9
    obeyed = min(max(-((time_ns - command_ns - body.watchdog_ns) // tick_ns), 0), ticks)
    if obeyed:
        advance_free(vector, command.linear, command.angular, obeyed, dt, body.limits, body.drift, noise)
    if obeyed < ticks:
        _tell_watchdog(run, time_ns + obeyed * tick_ns, tick_ns, events)
        advance_free(vector, 0.0, 0.0, ticks - obeyed, dt, body.limits, body.drift, noise[obeyed:])
    run.collided = False


def _advance_near(
    simulation: Simulation, run: Run, time_ns: int, tick_ns: int, noise: Floats, things: Around, events: list[Event]
) -> None:
    body = run.body
    command, command_ns = run.order
    if time_ns - command_ns >= body.watchdog_ns:
        _tell_watchdog(run, time_ns, tick_ns, events)
        command = REST
    touch = np.zeros(6)
    hit = simulation.scene.engine.advance_near(
        run.vector,
        command.linear,
        command.angular,
        tick_ns / 1e9,
        body.limits,
        body.drift,
        noise,
        body.shape,
        things.walls,
        things.circles,
        run.spec.on_collision == "slide",
        touch,
    )
    if hit and not run.collided:
        number, x, y, _, _, speed = touch.tolist()
        what = f"{run.name} met {things.names[int(number)]} at {speed:.2f} m/s"
        events.append(Event(time_ns + tick_ns, run.name, "collision", what, x, y, speed))
        run.collisions += 1
    run.collided = bool(hit)


def _tell_watchdog(run: Run, time_ns: int, tick_ns: int, events: list[Event]) -> None:
    """Note the first tick at which a command that asks for motion is dropped for its age."""
    command, command_ns = run.order
    fresh = time_ns - tick_ns - command_ns < run.body.watchdog_ns
    if fresh and (command.linear != 0.0 or command.angular != 0.0):
        x, y, _, v = run.vector[:4].tolist()
        what = f"{run.name} had no new command for {run.body.watchdog_ns / 1e9:g} s and stops"
        events.append(Event(time_ns, run.name, "watchdog", what, x, y, abs(v)))


def _noise(body: Body, tick: int, ticks: int) -> Floats:
    if body.drifts:
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


def _unpacked(robot: RobotState, run: Run) -> RobotState:
    x, y, theta, v, w, ox, oy, ot, xx, xy, xt, yy, yt, tt = run.vector.tolist()
    return RobotState(
        run.name,
        Pose(x, y, theta),
        Command(v, w),
        run.order[0],
        run.order[1],
        Pose(ox, oy, ot),
        (xx, xy, xt, xy, yy, yt, xt, yt, tt),
        run.collided,
        run.collisions,
        robot.held,
    )


def _holding(simulation: Simulation, state: State) -> State:
    """Keep, for each lidar that is frozen now, the state that it froze in."""
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
