"""The sources have no licence at their heads, as the cells of the notebook write them."""

from ament_copyright.main import main
import pytest


@pytest.mark.skip(reason='No copyright header has been placed in the generated source file.')
@pytest.mark.copyright
@pytest.mark.linter
def test_copyright():
    """Each file says whose it is."""
    assert main(argv=['.', 'test']) == 0, 'Found errors'
