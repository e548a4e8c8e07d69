"""The copyright headers, which the sources from the notebook do not have."""

from ament_copyright.main import main
import pytest


@pytest.mark.skip(reason='No copyright header has been placed in the generated source file.')
@pytest.mark.copyright
@pytest.mark.linter
def test_copyright():
    """Each file has a copyright header."""
    assert main(argv=['.', 'test']) == 0, 'Found errors'
