"""Requests to change parameters, drawn from all that the contract allows, and the contract's answer to each of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from hypothesis import strategies as st

from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support.contract import DEFAULTS

Values = Mapping[str, parameters.Value]
Request = tuple[tuple[str, parameters.Value], ...]  # names and values, in the order in which they are asked for
SAFETY, SLOW = DISTANCES = ("safety_distance", "slow_distance")
FOREIGN = "use_sim_time"  # rclpy's own parameter, which a request sets to the value that it has
LOW, HIGH = 20, 300  # cm: the limits of both distances
LENGTH = 5  # the largest number of requests in a dialogue
GAP, MARGIN = 30, 5  # cm: any reasonable rule accepts distances this far apart and this far from their limits
# Safety and slow distances in cm that fit, or contradict, each other, the defaults and all other clear values. So even
# a rule that compares the wrong distances gives the correct answer.
CLEAR_SAFETY, CLEAR_SLOW = st.integers(30, 45), st.integers(105, 200)
CLEAR_CONTRADICTION = st.tuples(st.integers(230, HIGH), st.integers(LOW, 25))
# The contract's answer to a request, or that a request changes no distance.
REFUSED, ACCEPTED, WITHOUT_DISTANCES = "refused", "accepted", "without distances"
Strategies = Mapping[str, st.SearchStrategy[parameters.Value]]
OTHER_PARAMETERS: Strategies = {  # parameters that have nothing to do with the distances
    "max_linear_velocity": st.sampled_from((0.4, 0.25)),
    "control_frequency": st.sampled_from((20.0, 12.5)),
    "battery_threshold": st.integers(10, 90),
}
ANY_VALUES: Strategies = {  # the same parameters, with any value within the limits
    "max_linear_velocity": st.sampled_from((0.0, 1.0)) | st.integers(1, 99).map(lambda percent: percent / 100),
    "control_frequency": st.sampled_from((1.0, 50.0)) | st.integers(3, 99).map(lambda halves: halves / 2),
    "battery_threshold": st.sampled_from((0, 100)) | st.integers(1, 99),
    FOREIGN: st.none(),
}


@dataclass(frozen=True)
class Dialogue:
    """A sequence of requests, and the safety distance and slow distance before the first one, in m."""

    present: tuple[float, float]
    requests: tuple[Request, ...]

    def __repr__(self) -> str:
        texts = "; ".join(values_text(dict(request)) for request in self.requests)
        return f"with {self.present[0]} m and {self.present[1]} m, requests for {texts}"


def fits(values: Values) -> bool:
    """Return whether the distances fit each other. A distance that is not named has its default."""
    return distance(values, SAFETY) < distance(values, SLOW)


def distance(values: Values, name: str) -> float:
    """Return the distance with this name, in m."""
    value = {**DEFAULTS, **values}[name]
    assert isinstance(value, int | float), value
    return float(value)


def values_text(request: Values) -> str:
    """Return a request in words."""
    return " and ".join(f"{name} = {'as it is' if value is None else value}" for name, value in request.items())


def pairs(gap: int = 1, margin: int = 0) -> st.SearchStrategy[dict[str, int]]:
    """Draw two distances in cm that fit each other, at least `gap` apart and `margin` from the limits."""
    low, high = LOW + margin, HIGH - margin
    edges = st.sampled_from(((50, 100), (low, high), (low, low + gap), (high - gap, high)))
    anywhere = st.integers(low, high - gap).flatmap(lambda at: st.tuples(st.just(at), st.integers(at + gap, high)))
    return (edges | anywhere).map(_named_distances)


def contradictions(safety: int, slow: int) -> st.SearchStrategy[dict[str, int]]:
    """Draw one or both distances in cm that contradict each other or the present one; the two may be equal."""
    both = st.integers(LOW, HIGH).flatmap(lambda low: st.tuples(st.integers(low, HIGH), st.just(low)))
    return (
        (st.just(slow) | st.integers(slow, HIGH)).map(lambda new: {SAFETY: new})
        | (st.just(safety) | st.integers(LOW, safety)).map(lambda new: {SLOW: new})
        | both.map(_named_distances)
    )


def matches(safety: int, slow: int, gap: int, margin: int) -> st.SearchStrategy[dict[str, int]]:
    """Draw one or both distances in cm that fit each other, or the present value of the other one."""
    choices = [pairs(gap, margin)]
    if slow - gap >= LOW + margin:
        choices.append(st.integers(LOW + margin, slow - gap).map(lambda new: {SAFETY: new}))
    if safety + gap <= HIGH - margin:
        choices.append(st.integers(safety + gap, HIGH - margin).map(lambda new: {SLOW: new}))
    return st.one_of(choices)


@st.composite
def requests(
    draw: st.DrawFn, distances: Mapping[str, int], other_parameters: Strategies, *, names_foreign: bool = False
) -> Request:
    """Draw a request for these distances in cm and other values, with the names in any order."""
    values: dict[str, parameters.Value] = {name: new / 100 for name, new in distances.items()}
    other_names = draw(st.lists(st.sampled_from(list(other_parameters)), unique=True, min_size=not values))
    values |= {FOREIGN: None} if names_foreign else {}
    values |= {name: draw(other_parameters[name]) for name in other_names}
    return tuple(draw(st.permutations(list(values.items()))))


@st.composite
def dialogues(
    draw: st.DrawFn,
    *kinds: str,
    first: str = "",
    other_parameters: Strategies = OTHER_PARAMETERS,
    is_clear: bool = False,
    names_foreign: bool = False,
) -> Dialogue:
    """Draw a dialogue.

    Args:
        draw: draws from a strategy.
        kinds: the kinds of the requests: `REFUSED`, `ACCEPTED` or `WITHOUT_DISTANCES`.
        first: the kind of the first request, if it differs.
        other_parameters: what a request may name besides the distances, each with its values.
        is_clear: whether any rule for the distances gives the contract's answers; other checks find wrong rules.
        names_foreign: whether each request names `FOREIGN`.
    """
    clear_pairs = st.tuples(CLEAR_SAFETY, CLEAR_SLOW).map(_named_distances)
    before = now = draw(clear_pairs if is_clear else pairs(GAP, MARGIN))
    drawn_requests = []
    for index in range(draw(st.integers(1 + bool(first), LENGTH))):
        kind = first if first and index == 0 else draw(st.sampled_from(kinds))
        distances: dict[str, int] = {}
        if kind == REFUSED:
            clear = CLEAR_CONTRADICTION.map(_named_distances)
            distances = draw(clear if is_clear else contradictions(now[SAFETY], now[SLOW]))
        elif kind == ACCEPTED:
            clear = clear_pairs | CLEAR_SAFETY.map(lambda new: {SAFETY: new}) | CLEAR_SLOW.map(lambda new: {SLOW: new})
            distances = draw(clear if is_clear else matches(now[SAFETY], now[SLOW], gap=1, margin=0))
            now = {**now, **distances}
        drawn_requests.append(draw(requests(distances, other_parameters, names_foreign=names_foreign)))
    return Dialogue((before[SAFETY] / 100, before[SLOW] / 100), tuple(drawn_requests))


def starts(kind: str) -> st.SearchStrategy[Request]:
    """Draw start values, whose distances fit or contradict each other, or the default of the one that is missing."""
    distances = contradictions(50, 100) if kind == REFUSED else matches(50, 100, GAP, MARGIN)
    return distances.flatmap(lambda drawn: requests(drawn, OTHER_PARAMETERS))


def _named_distances(distances: tuple[int, int]) -> dict[str, int]:
    return dict(zip(DISTANCES, distances, strict=True))
