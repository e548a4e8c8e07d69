"""What the nodes watch and offer."""

from robot_navigation_tutorial.navigation_controller import PARAMETERS
from robot_navigation_tutorial.status_monitor import WATCHED


def test_each_default_is_in_its_range():
    """A node that refuses its own default does not start."""
    for _, default, lowest, highest, _ in PARAMETERS:
        assert lowest <= default <= highest


def test_three_topics_are_watched():
    """The robot's sensor, its eyes and its hands."""
    assert sorted(WATCHED) == ['clearance', 'cmd_vel', 'scan']
