"""Names and numbers in the exercises' contracts, and hints and links that several checks use."""

from __future__ import annotations

PACKAGE = "my_robot_package"
UTILS = "my_robot_package.utils.data_processing"
PROCESSOR = "my_robot_package.nodes.sensor_processor"
ROBUST = "my_robot_package.nodes.robust_node"

HISTORY = 10  # scans over which mean_distance averages
WARN_PERIOD = 1.0  # s: the shortest time between two warnings
MAX_SILENCE = 1.5  # s: the longest time between two warnings while no scan has a distance
PERIOD = 1.0  # s between two readings of RobustNode
MAX_ERRORS = 10  # failures in a row: with more of them, RobustNode is unstable by default
TOLERANCE = 1e-4  # m: a range is a 32-bit float

RULE_MASK = "A reading is kept when it is an infinity or range_min <= reading <= range_max; else it becomes nan."
RULE_PLACE = "A reading's place in the list is its bearing: the returned list is as long as the given one."
RULE_MEAN = "math.isfinite(reading) is False for nan and for both infinities."
RULE_STATUS = "ok; failed: N in a row; unstable: N in a row."
REP_117 = "https://www.ros.org/reps/rep-0117.html"
QOS = "https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html"
LOGGING = "https://docs.ros.org/en/jazzy/Tutorials/Demos/Logging-and-logger-configuration.html"
RANDOM = "https://docs.python.org/3/library/random.html#random.Random"
ERRORS = "https://docs.python.org/3/tutorial/errors.html"
DEQUE = "https://docs.python.org/3/library/collections.html#collections.deque"
