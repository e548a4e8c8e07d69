"""No shared fixtures: each test file has its own."""
