"""Checks of the utilities: pure functions, which are called in the sandbox with drawn readings."""

from __future__ import annotations

import random
from math import inf, nan

from hypothesis import strategies as st

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import calls
from autograder.checks.ch07_best_practices.hidden.judged_calls import (
    judge_averages,
    judge_masked,
    judge_means,
    judge_processed,
)
from autograder.checks.ch07_best_practices.support.contract import (
    DEQUE,
    REP_117,
    RULE_MASK,
    RULE_MEAN,
    RULE_PLACE,
    UTILS,
)
from autograder.checks.ch07_best_practices.support.drawn_readings import (
    AT_ZERO,
    BEYOND_LIMIT,
    BLIND_SCANS,
    GOOD,
    GOOD_SCANS,
    HIGH,
    LOW,
    MAX_SCANS,
    ONE_BEAM,
    PHANTOMS,
    Readings,
    Series,
    draw_cases,
    expect_all,
    kept_readings,
    lists_with_a_mean,
    mean_of,
    other_lidars,
    scans_of,
    series,
)

check = group("utils")
FUNCTIONS = ("mask_invalid", "mean_distance", "process")
# For each kind of sequence, the module of its type, the type's name, and arguments that come before the readings.
SEQUENCES = {
    "a list": ("builtins", "list", ()),
    "a tuple": ("builtins", "tuple", ()),
    "an array.array": ("array", "array", ("d",)),
    "an array.array of 32-bit floats": ("array", "array", ("f",)),
    "a numpy array": ("numpy", "array", ()),
}


@check(points=1, covers=("mask", "places"), doc=REP_117)
@hint(RULE_PLACE, "A list comprehension with a conditional expression.")
def test_keeps_places(workspace: Workspace, draw: random.Random) -> None:
    """mask_invalid returns as many readings as it was given, each in its place."""

    def judge(case: Readings, masked: list[float]) -> None:
        lengths = f"{len(masked)} readings instead of {len(case.readings)}"
        expect(len(masked) == len(case.readings), f"{case.call} returned {lengths}: {masked}.")
        for index, reading in enumerate(case.readings):
            is_valid = case.low < reading < case.high
            message = f"The valid reading at index {index} became {masked[index]}: {case.call} returned {masked}."
            expect(not is_valid or calls.same(masked[index], reading), message)

    judge_masked(workspace, draw_cases(scans_of(GOOD | PHANTOMS), draw, 20), judge)


@check(points=2, covers=("phantoms", "mask"), after=("keeps_places",), doc=REP_117)
@hint(RULE_MASK, "0.0, a negative number and a number above range_max are not distances. nan stays nan.")
def test_masks_phantoms(workspace: Workspace, draw: random.Random) -> None:
    """mask_invalid replaces each number that cannot be a measurement with nan."""

    def judge(case: Readings, masked: list[float]) -> None:
        unmasked_readings = [reading for reading in masked if not calls.same(reading, nan)]
        expect(not unmasked_readings, f"{case.call} returned {masked}: each of these readings should become nan.")
        message = f"Of {list(case.readings)}, only {len(masked)} were replaced with nan. The others were dropped."
        expect(len(masked) == len(case.readings), message, fraction=0.5)  # another check tests the places of readings

    judge_masked(workspace, draw_cases(scans_of(PHANTOMS, min_size=1), draw, 20), judge)


@check(points=1, covers="mask", after=("keeps_places",))
@hint(RULE_MASK, "The range includes both limits: <=.")
def test_limits_count(workspace: Workspace, draw: random.Random) -> None:
    """A reading of exactly range_min or range_max is a measurement."""

    def judge(case: Readings, masked: list[float]) -> None:
        message = f"{case.call} returned {masked}: a reading of exactly range_min or range_max stays."
        expect(
            calls.same(kept_readings(masked), kept_readings(case.masked)),
            message,
            fraction=0.0 if case.is_usual else 0.5,
        )

    plain, from_zero = Readings((LOW, HIGH)), Readings((0.0, LOW / 2, HIGH), 0.0, HIGH)
    judge_masked(workspace, [plain, from_zero, *draw_cases(other_lidars(at_limits=True), draw, 12)], judge)


@check(points=2, covers=("infinities", "mask"), after=("keeps_places",), doc=REP_117)
@hint("In REP 117, +inf means that nothing came back, and -inf that something is too near.", RULE_MASK)
def test_infinities_stay(workspace: Workspace, draw: random.Random) -> None:
    """mask_invalid keeps both infinities, which have a meaning in REP 117."""

    def judge(case: Readings, masked: list[float]) -> None:
        expect(calls.same(masked, case.masked), f"{case.call} returned {masked}: inf and -inf stay, in their places.")

    judge_masked(workspace, draw_cases(scans_of(st.sampled_from((inf, -inf)) | GOOD, min_size=1), draw, 15), judge)


@check(points=2, covers="mask", after=("keeps_places",))
@hint("Each lidar has its own limits: the arguments range_min and range_max.", "Do not write 0.1 or 10.0.")
def test_the_lidars_own_limits(workspace: Workspace, draw: random.Random) -> None:
    """mask_invalid uses the lidar's own limits, not fixed numbers."""

    def judge(case: Readings, masked: list[float]) -> None:
        actual, expected = kept_readings(masked), kept_readings(case.masked)
        advice = f"it should keep {expected or 'none'}, and replace all others with nan."
        # Keeping a reading that is only just beyond a limit costs less.
        is_blatant = len(actual) < len(expected) or any(
            case.distance_beyond_limits(reading) > 2 * BEYOND_LIMIT for reading in actual
        )
        fraction = 0.0 if is_blatant else 0.75
        expect(calls.same(actual, expected), f"{case.call} returned {masked}: {advice}", fraction=fraction)

    judge_masked(workspace, draw_cases(other_lidars(at_limits=False), draw, 25), judge)


@check(points=1, covers=("leave-lists", "mask"), after=("keeps_places",))
@hint("Build a new list, and leave the given one as it is.", "ranges[i] = ... changes the caller's list.")
def test_input_untouched(workspace: Workspace, draw: random.Random) -> None:
    """mask_invalid, mean_distance and process do not change the lists that they are given."""
    plain_case = Readings((0.0, 1.0, 99.0))
    plan, cases = (
        calls.Plan(),
        [plain_case, *draw_cases(scans_of(GOOD | st.just(inf)) | scans_of(GOOD | PHANTOMS), draw, 12)],
    )
    processor = plan.add(calls.call("DataProcessor", 3))
    mask_steps = []
    for case in cases:
        limits, readings = (case.low, case.high), list(case.readings)
        readings_step = plan.add(calls.call("list", readings, module="builtins"))
        masked = plan.add(calls.call("mask_invalid", calls.result_of(readings_step), *limits))
        plan.add(calls.call("is_", calls.result_of(readings_step), calls.result_of(masked), module="operator"))
        plan.add(calls.call("process", readings, *limits, on=processor))
        plan.add(calls.call("mean_distance", readings))
        mask_steps.append(masked)
    outcomes = calls.run_steps(workspace, UTILS, *plan.steps)

    def judge(step: int) -> None:
        case = cases[mask_steps.index(step)]
        masked, is_same, processed, mean = outcomes[step : step + 4]
        if case is plain_case:  # other checks test whether the functions take other readings
            calls.value(masked, case.call)
            calls.value(processed, f"DataProcessor(3).process({case!r})")
        for function, outcome in (("mask_invalid", masked), ("process", processed), ("mean_distance", mean)):
            after = list(outcome.arguments[:1]) or [list(case.readings)]  # no arguments are known after an exception
            message = f"{function} changed the list that it was given: {list(case.readings)} became {after[0]}."
            expect(calls.same(after, [list(case.readings)]), message)
        message = f"{case.call} returned the caller's list itself instead of a new one."
        expect(is_same.value is False, message, fraction=0.75)

    expect_all(mask_steps, judge)


@check(points=2, covers="mean")
@hint(RULE_MEAN, "sum(...) / len(...) of the readings that are finite.")
def test_mean(workspace: Workspace, draw: random.Random) -> None:
    """mean_distance is the mean of the finite readings."""

    def judge(readings: list[float], mean: object) -> None:
        expected = mean_of(readings)
        assert expected is not None
        is_correct = isinstance(mean, int | float) and abs(mean - expected) < 1e-9
        message = f"mean_distance({readings}) returned {mean} instead of {expected:.4f}."
        expect(is_correct, message, fraction=0.0 if expected else 0.5)

    judge_means(workspace, draw_cases(lists_with_a_mean(), draw, 25), judge)


@check(points=1, covers="mean", after=("mean",))
@hint("Check that there is a finite reading before you divide.", "None means not known. 0.0 would mean touching.")
def test_no_mean(workspace: Workspace, draw: random.Random) -> None:
    """mean_distance returns None if no reading is finite."""

    def judge(readings: list[float], mean: object) -> None:
        expect(mean is None, f"mean_distance({readings}) returned {mean} instead of None.")

    judge_means(workspace, draw_cases(st.lists(st.sampled_from((nan, inf, -inf)), max_size=5), draw, 12), judge)


@check(points=1, covers=("sequences", "mask"), after=("keeps_places", "mean"))
@hint("Loop over the readings with `for`, and build a list of your own.", "`if ranges:` raises for a numpy array.")
def test_any_sequence(workspace: Workspace, draw: random.Random) -> None:
    """The utilities accept readings in a tuple, an array.array or a numpy array."""
    eighths = st.integers(2, 47).map(lambda number: number / 8)  # exact in 32 bits
    odd_readings = st.sampled_from((nan, inf, 18.0))
    drawn_scans = scans_of(eighths | odd_readings, low=0.125)
    plain_case = Readings((1.5, nan, 4.25, 18.0, inf), 0.125)
    cases = [plain_case, *draw_cases(drawn_scans | scans_of(eighths, low=0.125), draw, 8)]
    plan, first_steps = calls.Plan(), {}
    for case in cases:
        for kind, (module, name, first) in SEQUENCES.items():
            readings_step = plan.add(calls.call(name, *first, list(case.readings), module=module))
            processor = plan.add(calls.call("DataProcessor", 2))
            masked = plan.add(calls.call("mask_invalid", calls.result_of(readings_step), case.low, case.high))
            plan.add(calls.call("mean_distance", calls.result_of(readings_step)))
            plan.add(calls.call("process", calls.result_of(readings_step), case.low, case.high, on=processor))
            plan.add(calls.attribute("__name__", on=plan.add(calls.attribute("__class__", on=masked))))
            first_steps[case, kind] = masked
    outcomes = calls.run_steps(workspace, UTILS, *plan.steps)

    def judge(key: tuple[Readings, str]) -> None:
        case, kind = key
        start, list_start, readings = first_steps[key], first_steps[case, "a list"], list(case.readings)
        situation, type_name = f"With {readings} as {kind}", outcomes[start + len(FUNCTIONS) + 1].value
        message = f"{situation}, mask_invalid returned a value of type {type_name} instead of a list."
        expect(bool(outcomes[start].raised) or type_name == "list", message, fraction=0.75)
        for number, function in enumerate(FUNCTIONS):
            list_result = outcomes[list_start + number]  # other checks test whether this result is correct
            if case is plain_case or not list_result.raised:
                actual = calls.value(outcomes[start + number], f"{situation}, {function}")
                message = f"{situation}, {function} returned {actual}. With a list, it returned {list_result.value}."
                expect(calls.same(actual, list_result.value), message)

    expect_all(first_steps, judge)


@check(points=2, covers=("history", "process"), after=("keeps_places", "mean"), doc=DEQUE)
@hint("deque(maxlen=history).", "When the history is full, a new mean replaces the oldest one.")
def test_bounded_history(workspace: Workspace, draw: random.Random) -> None:
    """DataProcessor returns masked ranges, and remembers the means of the newest scans, at most `history` of them."""
    long_series = Series(tuple(draw_cases(GOOD_SCANS, draw, 12)), draw.randint(3, 6))
    judge_averages(workspace, [long_series], fraction=0.0)
    judge_averages(workspace, draw_cases(series(GOOD_SCANS, st.integers(1, 5)), draw, 12), fraction=0.5)
    scans = tuple(Readings((millimetres / 1000,)) for millimetres in draw.sample(range(1000, 5000), 107))
    judge_averages(workspace, [Series(scans, None)], fraction=0.75)
    judge_processed(workspace, [Readings((1.0, 0.0, inf, 9.0)), Readings((nan, -1.0))], fraction=0.75)


@check(points=1, covers=("process", "average"), after=("bounded_history", "no_mean"))
@hint("Append the mean only if it is not None.", "A scan without a distance says nothing about distances.")
def test_blind_scans_leave_no_mean(workspace: Workspace, draw: random.Random) -> None:
    """A scan without a finite distance adds nothing to the history. With an empty history, average() is None."""
    near, far, blind = Readings((2.0,)), Readings((4.0,)), Readings((nan,))
    judge_averages(workspace, [Series((blind, near, blind, blind, far), 3)], fraction=0.0)
    scans = ONE_BEAM | st.just(AT_ZERO) | BLIND_SCANS
    judge_averages(workspace, draw_cases(series(scans, st.just(MAX_SCANS)), draw, 20), fraction=0.5)


@check(points=1, covers="silent", after=("masks_phantoms", "mean", "bounded_history"))
@hint("A library returns data. Its caller decides what is logged.", "Remove print().")
def test_prints_nothing(workspace: Workspace, draw: random.Random) -> None:
    """The utilities print nothing: the node decides what is logged, and how often."""
    plan = calls.Plan()
    stream = plan.add(calls.call("StringIO", module="io"))
    system = plan.add(calls.call("import_module", "sys", module="importlib"))
    plan.add(calls.call("setattr", calls.result_of(system), "stderr", calls.result_of(stream), module="builtins"))
    plan.add(calls.call("simplefilter", "ignore", module="warnings"))  # a warning of numpy is not printed output
    plan.add(calls.call("disable", module="logging"))  # neither is a log record
    processor = plan.add(calls.call("DataProcessor", 3))
    for case in draw_cases(scans_of(GOOD | PHANTOMS | st.sampled_from((inf, -inf))), draw, 8):
        plan.add(calls.call("mask_invalid", list(case.readings), case.low, case.high))
        plan.add(calls.call("mean_distance", list(case.readings)))
        plan.add(calls.call("process", list(case.readings), case.low, case.high, on=processor))
        plan.add(calls.call("average", on=processor))
    # The utilities were imported before their output was recorded.
    utilities = plan.add(calls.call("import_module", UTILS, module="importlib"))
    plan.add(calls.call("reload", calls.result_of(utilities), module="importlib"))
    plan.add(calls.call("getvalue", on=stream))
    outcomes = calls.run_steps(workspace, UTILS, *plan.steps)
    for outcome in outcomes:
        expect(outcome.raised != "NotImplementedError", "The utilities are still to be written.")
    printed_text, errors = "".join(outcome.printed for outcome in outcomes), outcomes[-1].value
    expect(not printed_text, f"The utilities printed {printed_text[:80]!r}.")
    expect(not errors, f"The utilities printed to the standard error stream: {str(errors)[:80]!r}.", fraction=0.5)
