"""The code style that ROS 2 packages share."""

from ament_flake8.main import main_with_errors
import pytest


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8():
    """Each Python file of the package follows the style."""
    status, errors = main_with_errors(argv=[])
    assert status == 0, '\n'.join(errors)
