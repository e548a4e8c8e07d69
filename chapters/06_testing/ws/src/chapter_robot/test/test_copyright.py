import pytest
from ament_copyright.main import main


@pytest.mark.skip(reason='The source files have no copyright header yet.')
@pytest.mark.linter
def test_copyright():
    assert main(argv=['.', 'test']) == 0, 'Found errors'
