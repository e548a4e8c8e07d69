"""The defaults of the controller, and the topics of the monitor."""

from robot_navigation_tutorial.navigation_controller import PARAMETERS
from robot_navigation_tutorial.status_monitor import WATCHED


def test_each_default_is_in_its_range():
    """A node that refuses its own default does not start."""
    for _, default, lowest, highest, _ in PARAMETERS:
        assert lowest <= default <= highest


def test_three_topics_are_watched():
    """The monitor watches the three topics of the contract."""
    assert sorted(WATCHED) == ['clearance', 'cmd_vel', 'scan']
