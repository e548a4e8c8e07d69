"""A file of tests without a launch."""


def test_plain():
    pass
