"""The utilities: pure functions, which are called in the sandbox with readings drawn from the seed."""

from __future__ import annotations

import random
from math import inf, nan
from statistics import fmean
from typing import Any

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import calls
from autograder.checks.ch07_best_practices.support.contract import (
    DEQUE,
    REP_117,
    RULE_MASK,
    RULE_MEAN,
    RULE_PLACE,
    UTILS,
)

check = group("utils")
LOW, HIGH = 0.2, 6.0
BEYOND_LIMIT = 1e-4  # m beyond a limit, more than a rounding error
DEFAULT_HISTORY = 100
FUNCTIONS = ("mask_invalid", "mean_distance", "process", "average")
SEQUENCES = {
    "a list": ("builtins", "list", ()),
    "a tuple": ("builtins", "tuple", ()),
    "an array.array": ("array", "array", ("d",)),
    "a numpy array": ("numpy", "array", ()),
}


@check(points=1, covers=("mask", "places"), doc=REP_117)
@hint(RULE_PLACE, "A list comprehension with a conditional expression.")
def test_keeps_places(workspace: Workspace, draw: random.Random) -> None:
    """mask_invalid returns as many readings as it was given, each in its place."""
    readings = [round(draw.uniform(LOW, HIGH), 3) if i % 3 else draw.choice((0.0, nan, 50.0)) for i in range(40)]
    masked = _mask(workspace, readings)
    length = len(masked) if isinstance(masked, list) else masked
    expect(length == len(readings), f"{len(readings)} readings went in, {length} came out.")
    kept = [i for i in range(40) if i % 3]
    moved = next((i for i in kept if not calls.same(masked[i], readings[i])), None)
    expect(moved is None, f"The good reading in place {moved} came back as {masked[moved or 0]}.")


@check(points=2, covers=("phantoms", "mask"), after=("keeps_places",), doc=REP_117)
@hint(RULE_MASK, "0.0, a negative number and one beyond range_max are no distances; nan stays nan.")
def test_masks_phantoms(workspace: Workspace, draw: random.Random) -> None:
    """mask_invalid puts nan where a number cannot be a measurement."""
    phantoms = [0.0, -1.0, nan, LOW * draw.uniform(0.5, 0.99), HIGH * draw.uniform(1.01, 2.0)]
    masked = _mask(workspace, phantoms)
    unmasked = [reading for reading in masked if not calls.same(reading, nan)]
    expect(not unmasked, f"The limits are {LOW} and {HIGH} m, and {phantoms} became {masked}.")
    message = f"Of {phantoms}, {len(masked)} of {len(phantoms)} were replaced by nan, and the others dropped."
    expect(len(masked) == len(phantoms), message, fraction=0.5)  # another check tests the places of readings


@check(points=1, covers="mask", after=("keeps_places",))
@hint(RULE_MASK, "Both limits belong to the range: <=.")
def test_limits_count(workspace: Workspace) -> None:
    """A reading of exactly range_min or range_max is a measurement."""
    masked = _mask(workspace, [LOW, HIGH])
    expect(calls.same(masked, [LOW, HIGH]), f"[range_min, range_max] became {masked}.")


@check(points=2, covers=("infinities", "mask"), after=("keeps_places",), doc=REP_117)
@hint("REP 117: +inf says that nothing came back, -inf that something is too near.", RULE_MASK)
def test_infinities_stay(workspace: Workspace) -> None:
    """Both infinities are statements of the lidar, and stay."""
    masked = _mask(workspace, [inf, 1.0, -inf])
    expect(calls.same(masked, [inf, 1.0, -inf]), f"[inf, 1.0, -inf] became {masked}.")


@check(points=2, covers="mask", after=("keeps_places",))
@hint("A lidar says its own limits: range_min and range_max are arguments.", "Write no 0.1 and no 10.0.")
def test_the_lidars_own_limits(workspace: Workspace, draw: random.Random) -> None:
    """The limits are the lidar's own, not fixed numbers."""
    near, far = round(draw.uniform(0.02, 0.05), 3), round(draw.uniform(20.0, 30.0), 1)
    rows: tuple[tuple[list[float], list[float], float], ...] = (
        ([near, far, near / 2, far * 2], [near, far], 0.0),
        ([near - BEYOND_LIMIT, far + BEYOND_LIMIT], [], 0.75),
    )
    outcomes = calls.calls(
        workspace, UTILS, *(calls.call("mask_invalid", readings, near, far) for readings, _, _ in rows)
    )
    for outcome, (readings, expected, fraction) in zip(outcomes, rows, strict=True):
        call_text = f"mask_invalid({readings}, {near}, {far})"
        masked = calls.value(outcome, call_text)
        kept = [reading for reading in masked if not calls.same(reading, nan)] if isinstance(masked, list) else masked
        advice = f"it should keep {expected or 'none'}, and put nan in the place of the others."
        expect(calls.same(kept, expected), f"{call_text} returned {masked}: {advice}", fraction=fraction)


@check(points=1, covers=("leave-lists", "mask"), after=("keeps_places",))
@hint("Build a new list, leave the one that came as it is.", "ranges[i] = ... changes the caller's list.")
def test_input_untouched(workspace: Workspace) -> None:
    """What is given to mask_invalid, and to process, is left as it was."""
    readings = [0.0, 1.0, 99.0]
    (outcome,) = calls.calls(workspace, UTILS, calls.call("mask_invalid", readings, LOW, HIGH))
    calls.value(outcome, "mask_invalid(...)")
    processed = _process(workspace, 3, [readings])[1]
    calls.value(processed, "DataProcessor(3).process(...)")
    for result in (outcome, processed):
        expect(
            calls.same(list(result.arguments[:1]), [readings]), f"The caller's {readings} became {result.arguments[0]}."
        )
    for valid in ([1.0, inf, 2.0], []):
        *_, is_same = calls.calls(
            workspace,
            UTILS,
            calls.call("list", valid, module="builtins"),
            calls.call("mask_invalid", calls.result_of(0), LOW, HIGH),
            calls.call("is_", calls.result_of(0), calls.result_of(1), module="operator"),
        )
        call_text = f"mask_invalid({valid}, {LOW}, {HIGH})"
        expect(
            is_same.value is False,
            f"{call_text} returned the caller's list itself instead of a new one.",
            fraction=0.75,
        )


@check(points=2, covers="mean")
@hint(RULE_MEAN, "sum(...) / len(...) of the readings that are finite.")
def test_mean(workspace: Workspace, draw: random.Random) -> None:
    """mean_distance is the mean of the finite readings."""
    finite = [round(draw.uniform(LOW, HIGH), 3) for _ in range(9)]
    readings = [*finite, nan, inf, -inf]
    draw.shuffle(readings)
    (outcome,) = calls.calls(workspace, UTILS, calls.call("mean_distance", readings))
    mean = calls.value(outcome, "mean_distance(...)")
    is_right = isinstance(mean, int | float) and abs(mean - fmean(finite)) < 1e-9
    expect(is_right, f"The finite readings of {readings} have the mean {fmean(finite):.4f}, not {mean}.")
    (outcome,) = calls.calls(workspace, UTILS, calls.call("mean_distance", [0.0, nan]))
    mean = calls.value(outcome, "mean_distance(...)")
    expect(mean == 0.0, f"mean_distance([0.0, nan]) returned {mean} instead of 0.0.", fraction=0.5)


@check(points=1, covers="mean", after=("mean",))
@hint("Ask whether there is a finite reading before you divide.", "None says: not known. 0.0 says: touching.")
def test_no_mean(workspace: Workspace) -> None:
    """Without a finite reading, mean_distance is None."""
    for readings in ([], [nan, nan], [inf]):
        (outcome,) = calls.calls(workspace, UTILS, calls.call("mean_distance", readings))
        mean = calls.value(outcome, f"mean_distance({readings})")
        expect(mean is None, f"mean_distance({readings}) returned {mean} instead of None.")


@check(points=1, covers=("sequences", "mask"), after=("keeps_places", "mean"))
@hint("Go through it by `for`, and make a list of your own.", "A numpy array is neither true nor false, and not `[]`.")
def test_any_sequence(workspace: Workspace, draw: random.Random) -> None:
    """The readings may come as a tuple, as an array.array or as a numpy array."""
    near, far = round(draw.uniform(LOW, 3.0), 2), round(draw.uniform(3.0, HIGH), 2)
    readings = [near, nan, far, 3 * HIGH, inf]
    valid = [near, far]
    expected: list[Any] = []  # the results for a list; other checks test whether they are right
    for kind, (module, name, first) in SEQUENCES.items():
        *outcomes, returned = calls.calls(
            workspace,
            UTILS,
            calls.call(name, *first, readings, module=module),
            calls.call("DataProcessor", 2),
            calls.call("mask_invalid", calls.result_of(0), LOW, HIGH),
            calls.call("mean_distance", calls.result_of(0)),
            calls.call("process", calls.result_of(0), LOW, HIGH, on=1),
            calls.call("average", on=1),
            calls.call(name, *first, valid, module=module),
            calls.call("mask_invalid", calls.result_of(6), LOW, HIGH),
            calls.attribute("__class__", on=7),
            calls.attribute("__name__", on=8),
        )
        actual = [
            calls.value(outcome, f"{function} of {kind}")
            for function, outcome in zip(FUNCTIONS, outcomes[2:6], strict=True)
        ]
        expected = expected or actual
        for function, result, list_result in zip(FUNCTIONS, actual, expected, strict=True):
            message = f"With {readings} as {kind}, {function} returned {result}, and as a list {list_result}."
            expect(calls.same(result, list_result), message)
        message = f"With {valid} as {kind}, mask_invalid returned a value of type {returned.value} instead of a list."
        expect(returned.value == "list", message, fraction=0.75)


@check(points=2, covers=("history", "process"), after=("keeps_places", "mean"), doc=DEQUE)
@hint("deque(maxlen=history).", "The oldest mean goes when a new one comes and there is no room.")
def test_bounded_history(workspace: Workspace, draw: random.Random) -> None:
    """DataProcessor remembers the means of as many scans as it was told, the newest ones."""
    size, means = draw.randint(3, 6), [round(draw.uniform(1.0, 5.0), 3) for _ in range(12)]
    outcomes = _process(workspace, size, [[mean] * (1 + i % 3) for i, mean in enumerate(means)])
    average, expected = calls.value(outcomes[-1], "average()"), fmean(means[-size:])
    expect(
        calls.same(average, expected),
        f"After 12 scans, DataProcessor({size}).average() is {average}; the newest {size} have {expected:.4f}.",
    )
    more_means = [round(draw.uniform(1.0, 5.0), 3) for _ in range(DEFAULT_HISTORY + 7)]
    average, expected = (
        calls.value(_process(workspace, None, [[mean] for mean in more_means])[-1], "average()"),
        fmean(more_means[7:]),
    )
    message = (
        f"After {len(more_means)} scans, DataProcessor().average() is {average}; the newest 100 have {expected:.4f}."
    )
    expect(calls.same(average, expected), message, fraction=0.75)


@check(points=1, covers=("process", "average"), after=("bounded_history", "no_mean"))
@hint("Append the mean only if it is not None.", "A scan without a distance says nothing about distances.")
def test_blind_scans_leave_no_mean(workspace: Workspace) -> None:
    """A scan without a finite distance leaves no trace in the history, and without history there is no average."""
    for blind, fraction in ([nan], 0.0), ([inf, 0.0], 0.5):
        *_, average = _process(workspace, 3, [[2.0], blind, blind, [4.0]])
        actual = calls.value(average, "average()")
        message = f"After scans of 2 m, {blind}, {blind} and 4 m the average is {actual} instead of 3.0."
        expect(calls.same(actual, 3.0), message, fraction=fraction)
    *_, average = _process(workspace, 3, [[nan]])
    actual = calls.value(average, "average()")
    expect(actual is None, f"After one blind scan the average is {actual} instead of None.")
    process_calls = [calls.call("process", [metres], -1.0, HIGH, on=0) for metres in (0.0, 2.0)]  # 0 is a valid mean
    *_, average = calls.calls(
        workspace, UTILS, calls.call("DataProcessor", 2), *process_calls, calls.call("average", on=0)
    )
    actual = calls.value(average, "average()")
    expect(calls.same(actual, 1.0), f"After scans of 0 m and 2 m the average is {actual} instead of 1.0.", fraction=0.5)


@check(points=1, covers="silent", after=("masks_phantoms", "mean", "bounded_history"))
@hint("A library returns data; who calls it decides what is logged.", "Remove print().")
def test_prints_nothing(workspace: Workspace) -> None:
    """The utilities print nothing: what to say, and how often, is the node's business."""
    outcomes = _process(workspace, 3, [[0.0, 99.0, 1.0], [nan]])
    outcomes += calls.calls(
        workspace,
        UTILS,
        calls.call("StringIO", module="io"),
        calls.call("import_module", "sys", module="importlib"),
        calls.call("setattr", calls.result_of(1), "stderr", calls.result_of(0), module="builtins"),
        calls.call("simplefilter", "ignore", module="warnings"),  # a warning of numpy is not a print
        calls.call("disable", module="logging"),  # neither is a log record
        calls.call("mask_invalid", [0.0], LOW, HIGH),
        calls.call("mean_distance", [nan]),
        calls.call("getvalue", on=0),
    )
    for outcome in outcomes:
        expect(outcome.raised != "NotImplementedError", "They are still to be written.")
    printed, errors = "".join(outcome.printed for outcome in outcomes), outcomes[-1].value
    expect(not printed, f"They printed: {printed[:80]!r}")
    expect(not errors, f"They printed on the standard error stream: {str(errors)[:80]!r}", fraction=0.5)


def _mask(workspace: Workspace, readings: list[float]) -> list[float]:
    (outcome,) = calls.calls(workspace, UTILS, calls.call("mask_invalid", readings, LOW, HIGH))
    masked = calls.value(outcome, f"mask_invalid({readings}, {LOW}, {HIGH})")
    expect(isinstance(masked, list), f"mask_invalid returned {masked!r} instead of a list.")
    return list(masked)


def _process(workspace: Workspace, history: int | None, scans: list[list[float]]) -> list[calls.StepResult]:
    """Return the results of a new DataProcessor, of `process` for each scan, and of `average`.

    With `history` None, it has the default one.
    """
    sizes = () if history is None else (history,)
    process = [calls.call("process", readings, LOW, HIGH, on=0) for readings in scans]
    return calls.calls(workspace, UTILS, calls.call("DataProcessor", *sizes), *process, calls.call("average", on=0))
