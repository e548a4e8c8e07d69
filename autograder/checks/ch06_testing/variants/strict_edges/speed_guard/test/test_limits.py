"""Every line of safe_speed's contract at its edges, including None and nan."""

from math import inf, nan, nextafter

import pytest
from speed_guard.limits import safe_speed


@pytest.fixture(params=[(0.5, 1.5), (0.0, 1.0), (1.25, 3.25)], ids=str)
def distances(request):
    """Return a stop and a slow distance that make sense."""
    return request.param


@pytest.mark.parametrize(('stop', 'slow'), [
    (nan, 1.5), (0.5, nan), (nan, nan), (-inf, 1.0), (inf, inf), (1.0, 1.0),
    (nextafter(1.0, 2.0), 1.0), (-1e-9, 1.0),
])
@pytest.mark.parametrize('wanted', [0.5, 0.0, -0.5])
def test_not_zero_stop_slow_is_refused(stop, slow, wanted):
    """The first line holds for any wanted speed, and nan is not ordered."""
    with pytest.raises(ValueError):
        safe_speed(wanted, 5.0, stop, slow)
    with pytest.raises(ValueError):
        safe_speed(wanted, None, stop_distance=stop, slow_distance=slow)


@pytest.mark.parametrize('distance', [None, nan, -inf, inf, 0.0, 0.7, 9.0])
@pytest.mark.parametrize('wanted', [0.0, -1e-12, -2.0])
def test_back_is_free(wanted, distance, distances):
    """The way back is never guarded."""
    assert safe_speed(wanted, distance, *distances) == wanted


@pytest.mark.parametrize('unknown', [None, nan])
def test_unknown_is_a_stop(unknown, distances):
    """None and nan are unknown distances."""
    assert safe_speed(0.7, unknown, *distances) == 0.0


def test_stop_distance_itself_stops(distances):
    """The speed is 0.0 at the stop distance and nearer."""
    stop, _ = distances
    for distance in (stop, nextafter(stop, -inf), stop - 0.25, -inf):
        assert safe_speed(0.7, distance, *distances) == 0.0


def test_slow_distance_itself_is_clear(distances):
    """The speed is not limited at the slow distance and farther."""
    _, slow = distances
    for distance in (slow, slow + 0.25, 1e9, inf):
        assert safe_speed(0.7, distance, *distances) == pytest.approx(0.7)


def test_a_line_leads_from_one_to_the_other(distances):
    """The speed is proportional to the distance from the stop distance."""
    stop, slow = distances
    for eighth in range(1, 8):
        distance = stop + (slow - stop) * eighth / 8.0
        assert safe_speed(1.6, distance, *distances) == pytest.approx(0.2 * eighth)
