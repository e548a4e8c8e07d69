"""The checks of 06_testing."""
