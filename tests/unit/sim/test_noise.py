"""Random numbers: correctly distributed, keyed by their purpose, and the same on every machine."""

from __future__ import annotations

import hashlib
import math
import statistics
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.noise import key_of, normal, uniform, words, words_of_ticks

NORMAL = statistics.NormalDist()


@given(st.integers(0, 2**64 - 1))
def test_a_random_word_becomes_the_normal_quantile_of_its_uniform_number(word: int) -> None:
    raw = np.array([word], dtype=np.uint64)
    share = float(uniform(raw)[0])
    assert 0.0 < share < 1.0
    assert normal(raw)[0] == pytest.approx(NORMAL.inv_cdf(share), rel=1e-9, abs=1e-12)


def test_the_normal_numbers_have_the_moments_of_their_distribution() -> None:
    sample = normal(words(key_of(1, "robot", "range"), 5, 200_000))
    n = len(sample)
    assert abs(sample.mean()) < 5 / math.sqrt(n)
    assert abs(sample.var() - 1.0) < 5 * math.sqrt(2 / n)
    assert abs((sample**3).mean()) < 5 * math.sqrt(15 / n)
    assert abs((sample**4).mean() - 3.0) < 5 * math.sqrt(96 / n)


def test_the_random_words_of_a_key_never_change() -> None:
    blocks = words_of_ticks(key_of(2, "b", "c"), 9, 5)
    raw = np.concatenate((words(key_of(1, "robot", "range"), 7, 100), blocks.ravel()))
    hashes = [
        hashlib.sha256(bits.tobytes()).hexdigest()[:32] for bits in (raw.astype("<u8"), normal(raw).astype("<f8"))
    ]
    assert hashes == ["1526e530d2c0bbe0283f12ad23ce4a9d", "88c9b7601b545f95592240fef5302c5e"]


def test_each_tick_has_its_own_random_words_drawn_together_or_singly() -> None:
    key = key_of(3, "robot", "odometry")
    drawn_together = words_of_ticks(key, 10, 6)
    singly = [words_of_ticks(key, 10 + tick, 1)[0] for tick in range(6)]
    np.testing.assert_array_equal(drawn_together, singly)
    assert len(np.unique(drawn_together)) == drawn_together.size
    assert not np.array_equal(words(key, 1, 4), words(key, 2, 4))


def test_importing_the_simulator_imports_no_heavy_library() -> None:
    """The import loads no numba, plotting library, ROS or pandas, and the array engine needs none of them."""
    script = """
import sys
import sim
state = sim.start(simulation := sim.Simulation(sim.World.from_segments(sim.box(4, 3))))
assert sim.observe(simulation, sim.step(simulation, state, sim.Command(0.1, 0.1))) is not None
heavy = ("numba", "matplotlib", "PIL", "rclpy", "pandas", "scipy", "IPython", "ipywidgets")
print([name for name in heavy if name in sys.modules])
"""
    completed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert completed.stdout.strip() == "[]"
