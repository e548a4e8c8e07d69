"""The docstring style that ROS 2 packages share."""

from ament_pep257.main import main
import pytest


@pytest.mark.linter
@pytest.mark.pep257
def test_pep257():
    """Each docstring of the package follows PEP 257."""
    assert main(argv=['.', 'test']) == 0
