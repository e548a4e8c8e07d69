"""All that can be said without ROS."""

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
        """Refuse thresholds that would let it flutter."""
        if not self.cool < self.hot:
            raise ValueError(f'hot {self.hot} is not above cool {self.cool}')

    def at(self, celsius: float) -> 'Fan':
        """Return the fan after a temperature."""
        if not math.isfinite(celsius):
            return replace(self, cooling=True)
        if self.cool < celsius < self.hot:
            return self
        return replace(self, cooling=celsius >= self.hot)


@dataclass(frozen=True)
class Average:
    """The newest numbers, as a tuple."""

    size: int
    numbers: tuple[float, ...] = ()

    def after(self, number: float) -> 'Average':
        """Return the average after one more."""
        return replace(self, numbers=(*self.numbers, number)[-self.size:])

    @property
    def mean(self) -> float:
        """The mean."""
        return math.fsum(self.numbers) / len(self.numbers)


def turns(mean: float, swing: float) -> Iterator[float]:
    """Yield readings for ever."""
    for number in itertools.count():
        yield mean + swing * math.sin(number * math.pi / 10.0)
