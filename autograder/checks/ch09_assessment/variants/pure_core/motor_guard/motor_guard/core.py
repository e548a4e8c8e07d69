"""The logic of the three nodes, without ROS."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
import itertools
import math


@dataclass(frozen=True)
class Fan:
    """Two thresholds, and whether the fan runs."""

    hot: float
    cool: float
    cooling: bool = False

    def __post_init__(self):
        """Refuse thresholds in the wrong order."""
        if not self.cool < self.hot:
            raise ValueError(f'hot {self.hot} is not above cool {self.cool}')

    def after_temperature(self, celsius: float) -> 'Fan':
        """Return the fan in its state after a temperature."""
        if not math.isfinite(celsius):
            return replace(self, cooling=True)
        if self.cool < celsius < self.hot:
            return self
        return replace(self, cooling=celsius >= self.hot)


@dataclass(frozen=True)
class Average:
    """A moving average of the newest numbers."""

    size: int
    numbers: tuple[float, ...] = ()

    def with_number(self, number: float) -> 'Average':
        """Return the average with one more number."""
        return replace(self, numbers=(*self.numbers, number)[-self.size:])

    @property
    def mean(self) -> float:
        """The mean of the newest numbers."""
        return math.fsum(self.numbers) / len(self.numbers)


def temperatures(mean: float, swing: float) -> Iterator[float]:
    """Yield the readings without end."""
    for number in itertools.count():
        yield mean + swing * math.sin(number * math.pi / 10.0)
