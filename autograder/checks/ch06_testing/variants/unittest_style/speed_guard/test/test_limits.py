"""The contract of safe_speed, as cases of the standard library's unittest."""

import itertools
import math
import unittest

import pytest
from speed_guard.limits import safe_speed


class SafeSpeed(unittest.TestCase):
    """One method for each line of the contract."""

    def test_value_error(self):
        """The distances are refused unless 0 <= stop < slow."""
        for stop, slow in [(-1e-3, 2.0), (0.7, 0.7), (0.9, 0.2), (-2.0, -1.0)]:
            for wanted in (0.2, -0.2):
                with self.subTest(stop=stop, slow=slow), pytest.raises(ValueError):
                    safe_speed(wanted, 5.0, stop_distance=stop, slow_distance=slow)

    def test_not_forward(self):
        """Speeds up to 0 are returned unchanged."""
        distances = None, math.nan, -math.inf, 0.0, 1.0, 9.0
        for wanted, distance in itertools.product((-1.5, -0.01, 0.0), distances):
            with self.subTest(wanted=wanted, distance=distance):
                assert safe_speed(wanted, distance) == wanted

    def test_none(self):
        """None is an unknown distance."""
        assert safe_speed(1.1, None) == 0.0

    def test_nan(self):
        """Nan is also an unknown distance."""
        assert safe_speed(1.1, math.nan) == 0.0

    def test_near(self):
        """The speed is 0.0 near an obstacle."""
        for distance in (-math.inf, 0.0, 0.1, 0.49, 0.5):
            with self.subTest(distance=distance):
                assert safe_speed(1.1, distance) == pytest.approx(0.0, abs=1e-9)

    def test_far(self):
        """Far obstacles do not limit the speed."""
        for distance in (1.5, 1.51, 30.0, math.inf):
            with self.subTest(distance=distance):
                assert safe_speed(1.1, distance) == pytest.approx(1.1, abs=1e-9)

    def test_line(self):
        """On a grid of distances, the speed is on the straight line."""
        for stop, slow in ((0.5, 1.5), (0.0, 2.0), (0.2, 4.2)):
            for step in range(11):
                distance = stop + (slow - stop) * step / 10
                with self.subTest(stop=stop, slow=slow, distance=distance):
                    speed = safe_speed(0.4, distance, stop, slow)
                    assert speed == pytest.approx(0.04 * step, abs=1e-6)
