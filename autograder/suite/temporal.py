"""Temporal logic over recorded traces: how well a formula holds, and when it is first violated.

Formulas are signal temporal logic in discrete time, evaluated by rtamt with quantitative semantics (robustness): the
value is positive where the formula holds, and its magnitude is the distance to a violation, in the signals' own units.
"""

from __future__ import annotations

import sys
import typing
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

# rtamt's parser (antlr4 4.7) takes TextIO from typing.io, which is deprecated in Python 3.11 and removed in 3.13.
sys.modules["typing.io"] = typing
import rtamt  # noqa: E402

from autograder.suite.declaration import expect  # noqa: E402


@dataclass(frozen=True)
class Verdict:
    """The result of "always CONDITION" on a trace.

    Attributes:
        robustness: the smallest value of the condition; above 0 if it always holds.
        violated_at: the first time, in seconds, at which the condition does not hold; None if it always does.
        times: the trace's times, in seconds.
        values: the condition's value at each time.
    """

    robustness: float
    violated_at: float | None
    times: tuple[float, ...] = field(default=(), repr=False)
    values: tuple[float, ...] = field(default=(), repr=False)


def always(condition: str, times: Sequence[float], signals: Mapping[str, Sequence[float]]) -> Verdict:
    """Evaluate "always CONDITION" on a trace.

    Args:
        condition: a formula of rtamt, such as `gap > 0.05` or `(blocked > 0) implies eventually[0:10] (turn > 0)`; its
            intervals count samples.
        times: the times of the samples, in seconds, ascending; at least two.
        signals: for each name in the formula, one value per sample.

    Raises:
        rtamt.RTAMTException: the formula is malformed.
        CheckFailed: the trace has fewer than two samples, for example because a program sent nothing.
    """
    expect(len(times) > 1, "Fewer than two messages were received, so this check could not be evaluated.")
    specification = rtamt.StlDiscreteTimeSpecification()
    for name in signals:
        specification.declare_var(name, "float")
    specification.spec = condition
    specification.parse()
    trace = {name: [float(value) for value in values] for name, values in signals.items()}
    values = [value for _, value in specification.evaluate({"time": list(range(len(times))), **trace})]
    violation = next((index for index, value in enumerate(values) if value <= 0.0), None)
    seconds = tuple(float(time) for time in times)
    return Verdict(
        float(min(values)), None if violation is None else seconds[violation], seconds, tuple(map(float, values))
    )
