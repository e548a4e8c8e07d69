"""The names and numbers in the requirements, whose sentences are in the notebook."""

PACKAGE = "NEW_PACKAGE"
EXECUTABLE = "NEW_NODE"
RANGE_MIN, RANGE_MAX = 0.12, 3.5  # m
TOLERANCE = 1e-5  # m: a reading is a 32-bit float
