"""Question 3: what each of the three nodes does, with parameters and temperatures drawn from the seed."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from random import Random

from autograder.checking import LOCKSTEP, CheckFailed, ReceivedMessage, Workspace, expect, group, hint
from autograder.checking.probes import calls, namespaces, node_callbacks
from autograder.checks.ch09_assessment.support import contract
from autograder.checks.ch09_assessment.support.contract import (
    COOL,
    GUARD,
    HOT,
    INTERFACES,
    MEAN,
    PACKAGE,
    PERIOD,
    SMOOTHER,
    SWING,
    THERMOMETER,
    WINDOW,
    averages,
    decisions,
    reading,
)
from autograder.checks.ch09_assessment.support.robot import NANOSECONDS, NodeHarness, Start, Types, near, refuses

check = group("nodes")
BUILT = ("installs",)
BETWEEN = (COOL + 1.0, HOT - 1.0)
COUNT = 12  # readings in a stretch
FRESH = 0.1  # s that a reading may take to come
LATE = 2.2  # s after the start of a node to which nobody listens before
HEARD = 2.2  # s for which readings are heard, five periods and a part of one
FLOAT32 = 1e-6  # the precision of a number in a message
BARELY = 0.002  # degrees: what is rounded to hundredths is no longer between the thresholds
HUGE = 1e20  # degrees: a sum that it once was part of has lost all others
SILENCE = 2.5  # s without an average, in which nothing changes
STAMP = (1_700_000_000, 123_456_789)  # s and ns, as of our time: a float of seconds does not hold them
QUEUE = 10
SLOW = 0.25  # of ROS time: how fast the machine's clocks run for a node that must not look at them


@check(
    points=2,
    covers=("reading", "formula", "period", "mean-swing", "thermometer-topics"),
    after=BUILT,
    doc=contract.NODES_DOC,
)
@hint("create_timer(period, self.timer_callback), and a count in self.", "math.sin takes radians.")
def test_readings(start: Start) -> None:
    """Thermometer publishes two readings a second, which swing around the mean as the contract says."""
    with start(THERMOMETER) as harness:
        harness.expect_in_graph()
        harness.expect_readings(30)


@check(points=2, covers=("period", "mean-swing", "at-start"), after=("readings",), doc=contract.PARAMETERS_DOC)
@hint("self.declare_parameter('mean', 50.0).value, and use it.", "create_timer takes the parameter period.")
def test_thermometer_parameters(start: Start, draw: Random) -> None:
    """Thermometer measures by its parameters period, mean and swing."""
    period, mean, swing = draw_wave(draw)
    try:
        _expect_measured(start, period, mean, swing, reading)
    except CheckFailed:  # whether it goes up and down by the formula, another check says
        _expect_measured(start, period, mean, swing, _own_reading(start))


@check(points=1, covers=("reading", "formula"), after=("readings",), doc=contract.NODES_DOC)
@hint("stamp=self.get_clock().now().to_msg()", "time.time() knows nothing of ROS time.")
@hint("The timer starts in __init__, and its callback does not ask who listens.")
def test_stamps(start: Start) -> None:
    """Each reading is made in its period, whoever listens, and stamped with the node's clock at that time."""
    with start(THERMOMETER) as harness:
        heard = _expect_fresh(harness)
        harness.run(LATE)
        own = [received.message.celsius for received in harness.published()]
    in_lockstep = harness.time == LOCKSTEP  # in real time the grader cannot see when the node started
    period = heard[1].seconds - heard[0].seconds if len(heard) > 1 else PERIOD
    if in_lockstep:
        first = heard[0].seconds
        said = f"The first reading came {first:.2f} s after the start, and its period is {period:.2f} s."
        expect(abs(first - period) < period / 2, said, fraction=0.5)
    with start(THERMOMETER, clock_rate=SLOW, is_heard=False) as harness:
        harness.run(LATE)
        harness.listen_late()
        heard = _expect_fresh(harness)
    for received in heard if in_lockstep else ():
        number, celsius = round(received.seconds / period) - 1, received.message.celsius
        wanted = own[number] if number < len(own) else celsius
        said = (
            f"Nobody listened for {LATE} s; the reading {received.seconds:.2f} s after the start was {celsius:.2f} °C"
        )
        wish = f"where somebody listens, it was {wanted:.2f} °C: it measures each period, whoever listens."
        expect(near(celsius, wanted), f"{said}; {wish}", fraction=0.5)


@check(points=2, covers=("smoother", "window", "smoother-topics"), after=BUILT, doc=contract.NODES_DOC)
@hint("sum(...) / len(...) of what the window holds now; at the start that is less.", "Publish for each reading.")
def test_average(workspace: Workspace, start: Start, draw: Random) -> None:
    """Smoother publishes, for each reading, the average of the newest five, with the stamp of the newest."""
    readings = [round(draw.uniform(20.0, 80.0), 1) for _ in range(12)]
    with start(SMOOTHER) as harness:
        harness.expect_in_graph()
        told = harness.send(readings, first=7)
    _expect_averages([message.celsius for message in told], readings, WINDOW)
    stamps = [(message.stamp.sec, message.stamp.nanosec) for message in told]
    right = stamps == [(second, NANOSECONDS) for second in range(7, 7 + len(readings))]
    expect(right, "The stamp of an average is not that of the newest reading.", fraction=0.66)
    with start(SMOOTHER) as harness:
        told = harness.send([readings[0]] * QUEUE, apart=0.0)
    said = f"Of {QUEUE} readings that came at once, {len(told)} got an average: a queue of {QUEUE} holds them all."
    expect(len(told) == QUEUE, said, fraction=0.75)
    _expect_own_window(workspace)


def _expect_own_window(workspace: Workspace) -> None:
    """Fail the check if of two smoothers in one process each averages what the other was sent."""
    node = calls.call("Smoother")
    cold, warm = (calls.call("Temperature", module=f"{INTERFACES}.msg", celsius=celsius) for celsius in (20.0, 40.0))
    turns = [(number, "temperature_callback", message) for number, message in ((0, cold), (1, warm), (0, cold))]
    texts = node_callbacks.published(workspace, f"{PACKAGE}.{SMOOTHER}", [node, node], turns)
    said = [re.findall(r"celsius=(-?\d{1,40}(?:\.\d{1,40})?)[,)]", text) for text in texts]
    if not all(len(averages) == 1 for averages in said):
        return  # it publishes otherwise than in its callback, which is allowed
    got = [float(average) for (average,) in said]
    sentence = "Of two smoothers in one process, one was sent readings of 20 °C and the other one of 40 °C"
    right = all(map(near, got, (20.0, 40.0, 20.0)))
    expect(right, f"{sentence}, and the other one said {got[1]:.1f} °C: each averages its own.", fraction=0.5)


@check(points=2, covers=("smoother", "window", "at-start"), after=("average",), doc=contract.PARAMETERS_DOC)
@hint("deque(maxlen=window)", "IntegerRange(from_value=1, to_value=100) in the descriptor.")
def test_window(workspace: Workspace, types: Types, start: Start, draw: Random) -> None:
    """The parameter window says how many readings count, from 1 to 100; 0, 101 and 2.5 are refused at the start."""
    window, readings = draw.randint(2, 4), [round(draw.uniform(20.0, 80.0), 1) for _ in range(8)]
    with start(SMOOTHER, window=window) as harness:
        told = harness.send(readings)
        _expect_full_averages([message.celsius for message in told], readings, window)
        harness.try_to_set(window=1)
        told += harness.send(readings)
        after = "After another window was set: "
        _expect_full_averages([message.celsius for message in told], readings * 2, window, after, fraction=0.5)
    for limit, right in ((0, False), (1, True), (100, True), (101, False), (2.5, False)):
        started = not refuses(workspace, types, SMOOTHER, window=limit)
        said = f"smoother {'started' if started else 'did not start'} with window {limit}."
        expect(started is right, said, fraction=0.5)
    cold = [readings[0], 0.0, *(-celsius for celsius in readings[:3])]
    with start(SMOOTHER, window=1) as harness:
        told = harness.send(cold)
    where = f"At {', '.join(map(str, cold))} °C: "
    _expect_averages([message.celsius for message in told], cold, 1, where, fraction=0.75)


@check(points=2, covers=("not-finite", "window"), after=("average",))
@hint("math.isfinite(reading.celsius)", "A reading that does not count gets no average either.")
def test_no_number(start: Start, draw: Random) -> None:
    """A reading that is nan or infinite does not count, and nothing is published for it."""
    first, second = round(draw.uniform(30.0, 40.0), 1), round(draw.uniform(50.0, 60.0), 1)
    with start(SMOOTHER, window=2) as harness:  # what does not count takes no place, either
        told = harness.send([first, math.nan, math.inf, -math.inf, second])
        after = harness.send([HUGE, first, second])
    seen = [round(message.celsius, 2) for message in told]
    shown = f"{first}, nan, inf, -inf, {second} °C became {seen}"
    wanted = [first, (first + second) / 2]
    last = bool(seen) and abs(seen[-1] - wanted[-1]) <= 0.01
    expect(last, f"{shown}: the last average should have been {wanted[-1]:.2f}.")
    expect(len(seen) <= 2, f"{shown}: there are averages for what is no number.", fraction=0.5)
    forgotten = bool(after) and abs(after[-1].celsius - wanted[-1]) <= 0.01
    expect(
        forgotten, f"Two readings after one of {HUGE:g} °C, which is finite, the average still has it.", fraction=0.75
    )


@check(points=4, covers=("hysteresis", "guard-topics"), after=BUILT, doc=contract.NODES_DOC)
@hint("Two thresholds, and a decision that is remembered.", "elif: from hot on True, down to cool False.")
def test_hysteresis(start: Start, draw: Random) -> None:
    """Guard switches the fan on when it is hot, off when it is cool, and leaves it as it was between the two."""
    between = [round(draw.uniform(*BETWEEN), 1) for _ in range(4)]
    cold, warm = round(draw.uniform(10.0, 40.0), 1), round(draw.uniform(70.0, 90.0), 1)
    with start(GUARD) as harness:
        harness.expect_in_graph()
        _expect_decisions(harness, [cold, warm, cold], "")
        _expect_decisions(harness, [warm, *between[:2], cold, *between[2:]], "Between the thresholds: ", fraction=0.5)
        _expect_decisions(harness, [HOT, COOL, HOT - 0.1, HOT, COOL + 0.1], "At the thresholds: ", fraction=0.75)
    with start(GUARD) as harness:
        _expect_decisions(harness, between[:1], "At the start the fan is off: ", fraction=0.75)


@check(points=2, covers=("hot-cool", "hysteresis", "at-start"), after=("hysteresis",), doc=contract.PARAMETERS_DOC)
@hint("self.declare_parameter('hot', 60.0).value, and cool likewise.", "raise ValueError(...) in __init__.")
@hint("self.hot = ... in __init__ is read once; get_parameter in a callback is not.")
def test_thresholds(workspace: Workspace, types: Types, start: Start, draw: Random) -> None:
    """Guard decides by hot and cool as they were at its start, which fails unless cool is less than hot."""
    hot, cool = draw_thresholds(draw)
    with start(GUARD, hot=hot, cool=cool) as harness:
        where = f"With hot {hot} and cool {cool}: "
        _expect_decisions(harness, [cool - 1.0, hot + 1.0, cool - 1.0], where, hot=hot, cool=cool)
        between = [cool + 1.0, hot + 1.0, cool + 1.0, cool - 1.0, hot - 1.0]
        _expect_decisions(harness, between, where, hot=hot, cool=cool, fraction=0.5)
        close = [hot - BARELY, hot + 1.0, cool + BARELY, cool - 1.0]
        _expect_decisions(harness, close, where, hot=hot, cool=cool, fraction=0.75)
        harness.run(SILENCE)
        silent = f"{where}after {SILENCE} s without an average, "
        _expect_decisions(harness, [cool + 1.0], silent, hot=hot, cool=cool, fraction=0.75)
        harness.try_to_set(hot=hot + 5.0, cool=cool - 5.0)
        where = f"Started with hot {hot} and cool {cool}, both then set 5 °C further apart: "
        _expect_decisions(harness, [hot + 1.0, cool - 1.0], where, hot=hot, cool=cool, fraction=0.5)
    for high, low in ((hot, hot), (hot, hot + 5.0), (hot, math.nan), (math.nan, cool)):
        refused = refuses(workspace, types, GUARD, hot=high, cool=low)
        expect(refused, f"guard started with hot {high} and cool {low}.", fraction=0.5)


@check(points=1, covers="unknown", after=("hysteresis",))
@hint("nan >= 60.0 is False, and so is nan <= 50.0.", "Ask math.isfinite first.")
def test_unknown(start: Start) -> None:
    """When the temperature is no finite number, it is not known, and the fan runs."""
    with start(GUARD) as harness:
        for unknown in (math.nan, -math.inf):
            # What it does between the thresholds after that, the contract leaves open.
            _expect_decisions(harness, [20.0, unknown, 20.0, 70.0, unknown, 20.0], "")


@check(points=1, covers=("guard", "guard-topics"), after=("hysteresis",))
@hint("stamp=average.stamp", "Who reads a decision wants to know of when and of what it was.")
def test_passes_on(start: Start, draw: Random) -> None:
    """Each average gets a decision, which carries the stamp and the temperature that it was made of."""
    given = [draw.uniform(70.0, 90.0), draw.uniform(*BETWEEN), draw.uniform(20.0, 40.0)]
    first, nanoseconds = STAMP[0] + draw.randint(100, 999), STAMP[1]
    with start(GUARD) as harness:
        told = harness.send(given, first, nanoseconds=nanoseconds)
        answers = harness.send([math.nan])  # whether there is one is for test_unknown to say
    expect(len(told) == len(given), f"{len(given)} averages became {len(told)} decisions.")
    for second, (celsius, decision) in enumerate(zip(given, told, strict=True), first):
        stamp = decision.stamp
        right = (stamp.sec, stamp.nanosec) == (second, nanoseconds)
        said = f"The decision's stamp is {stamp.sec} s and {stamp.nanosec} ns"
        wanted = f"the average's, at {celsius:.1f} °C, was {second} s and {nanoseconds} ns."
        partly = second > first or stamp.sec == second
        expect(right, f"{said}; {wanted}", fraction=0.5 if partly else 0.0)
        same = math.isclose(decision.celsius, celsius, rel_tol=FLOAT32)
        expect(same, f"The decision on {celsius:.5f} °C says {decision.celsius:.5f} °C.", fraction=0.5)
    named = [answer.celsius for answer in answers if not math.isnan(answer.celsius)]
    expect(not named, f"The decision on nan °C, which is not known, says {named} °C.", fraction=0.5)
    with start(GUARD) as harness:
        made = len(harness.send(given[:1] * QUEUE, apart=0.0))
    said = f"Of {QUEUE} averages that came at once, {made} got a decision: a queue of {QUEUE} holds them all."
    expect(made == QUEUE, said, fraction=0.5)


@check(points=1, covers="relative", after=("installs", "readings", "average", "hysteresis"), doc=contract.NODES_DOC)
@hint("A name that begins with a slash is the same in every namespace: two robots would share it.")
@hint("'temperature' is relative, '/temperature' is not.")
def test_relative(workspace: Workspace) -> None:
    """The topics have plain queues and relative names: in the namespace /a, temperature is /a/temperature."""
    topics = {
        THERMOMETER: ("temperature",),
        SMOOTHER: ("temperature", "smoothed"),
        GUARD: ("smoothed", "decision"),
    }
    left = [
        said
        for name, names in topics.items()
        if (said := namespaces.missing_in_namespace(workspace, contract.PACKAGE, name, names, plain=True))
    ]
    expect(not left, " ".join(left))


def draw_wave(draw: Random) -> tuple[float, float, float]:
    """Return a period in s, a mean and a swing in degrees Celsius."""
    period = draw.choice((0.1, 0.2, 0.8))
    return period, round(draw.uniform(20.0, 40.0), 1), round(draw.uniform(3.0, 9.0), 1)


def draw_thresholds(draw: Random) -> tuple[float, float]:
    """Return the temperatures hot and cool in degrees Celsius."""
    cool = round(draw.uniform(20.0, 30.0), 1)
    return round(cool + draw.uniform(5.0, 10.0), 1), cool


def _expect_measured(start: Start, period: float, mean: float, swing: float, reading: Callable[..., float]) -> None:
    """Fail the check unless a thermometer goes by these parameters, also after others were set."""
    with start(THERMOMETER, period=period, mean=mean, swing=swing) as harness:
        harness.expect_readings(COUNT, period, mean, swing, reading=reading)
        harness.try_to_set(period=2 * period, mean=mean + 10.0, swing=swing + 5.0)
        try:
            harness.expect_readings(COUNT, period, mean, swing, reading=reading)
        except CheckFailed as failed:
            raise CheckFailed(f"With other parameters set after the start: {failed.message}", fraction=0.5) from failed


def _own_reading(start: Start) -> Callable[[int, float, float], float]:
    """Return what the student's thermometer would measure by other parameters, going by what it does by default."""
    with start(THERMOMETER) as harness:
        harness.run((2 * COUNT + 2) * PERIOD)
        own = [(received.message.celsius - MEAN) / SWING for received in harness.published()]
    return lambda number, mean, swing: mean + swing * own[number] if number < len(own) else math.nan


def _expect_fresh(harness: NodeHarness) -> list[ReceivedMessage]:
    """Return the thermometer's next readings; fail the check unless each was stamped as it came."""
    began = harness.seconds
    harness.run(HEARD)
    now_ns, now, heard = harness.now_ns, harness.seconds, harness.published(began)
    came = [now_ns - round((now - received.seconds) * 1e9) for received in heard]
    stamps = [received.message.stamp for received in heard]
    ages = [
        round((instant - stamp.sec * 10**9 - stamp.nanosec) / 1e9, 3)
        for instant, stamp in zip(came, stamps, strict=True)
    ]
    right = bool(ages) and all(abs(age) < FRESH for age in ages)
    said = f"By their stamps, its readings were {ages} s old when they came"
    expect(right, f"{said}: a reading is sent as it is made, and the node's clock says when.")
    return heard


def _expect_averages(
    seen: list[float], readings: list[float], window: int, where: str = "", *, fraction: float = 0.0
) -> None:
    count = f"{where}{len(readings)} readings became {len(seen)} averages."
    expect(len(seen) == len(readings), count, fraction=fraction)
    wanted = averages(readings, window)
    wrong = next((n for n in range(len(readings)) if not near(seen[n], wanted[n])), 0)
    newest = ", ".join(map(str, readings[: wrong + 1][-window:]))
    right = near(seen[wrong], wanted[wrong])
    said = f"With the window {window}, the average of {newest} °C was {seen[wrong]:.2f} °C."
    expect(right, f"{where}{said}", fraction=fraction)


def _expect_full_averages(
    seen: list[float], readings: list[float], window: int, where: str = "", *, fraction: float = 0.0
) -> None:
    """Judge those averages for which the window is full: what stands before, another check judges."""
    wanted = averages(readings, window)[window - 1 :]
    newest = seen[-len(wanted) :]
    count = f"{where}{len(readings)} readings became {len(seen)} averages."
    expect(len(newest) == len(wanted) and len(seen) <= len(readings), count, fraction=fraction)
    wrong = next((n for n in range(len(wanted)) if not near(newest[n], wanted[n])), None)
    shown = ", ".join(map(str, readings[wrong : wrong + window])) if wrong is not None else ""
    said = f"With the window {window}, the average of {shown} °C was {newest[wrong or 0]:.2f} °C."
    expect(wrong is None, f"{where}{said}", fraction=fraction)


def _expect_decisions(
    harness: NodeHarness,
    temperatures: list[float],
    where: str,
    *,
    hot: float = HOT,
    cool: float = COOL,
    fraction: float = 0.0,
) -> None:
    seen = [bool(message.cooling) for message in harness.send(temperatures)]
    expect(len(seen) == len(temperatures), f"{len(temperatures)} averages became {len(seen)} decisions.")
    wanted = decisions(temperatures, hot, cool)
    shown = ", ".join(f"{celsius:g}" for celsius in temperatures)
    said = f"{where}at {shown} °C, cooling was {seen} and should have been {wanted}."
    expect(seen == wanted, said[:1].upper() + said[1:], fraction=fraction)
