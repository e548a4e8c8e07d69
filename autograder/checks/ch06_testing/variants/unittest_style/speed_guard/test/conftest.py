"""Each test file has what it needs."""
