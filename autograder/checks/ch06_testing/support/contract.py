"""Names and numbers in the exercises' contract, and links and hints that several checks use."""

from __future__ import annotations

PACKAGE = "speed_guard"
SCRIPTS = {"speed_guard": "speed_guard.guard"}
LIMITS, GUARD, LAUNCH = "test_limits.py", "test_guard.py", "test_launch.py"
MIN_TESTS = {LIMITS: 6, GUARD: 5, LAUNCH: 1}  # how many tests a file needs at least
GIVEN_TESTS = {LIMITS: 4, GUARD: 0, LAUNCH: 0}  # how many tests the notebook provides

PYTEST = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Testing/Python.html"
INTEGRATION = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Testing/Integration.html"
CLI = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Testing/CLI.html"
APPROX = "https://docs.pytest.org/en/stable/reference/reference.html#pytest-approx"
RAISES = "https://docs.pytest.org/en/stable/how-to/assert.html#assertions-about-expected-exceptions"
FIXTURES = "https://docs.pytest.org/en/stable/how-to/fixtures.html#teardown-cleanup-aka-fixture-finalization"
DOMAIN = "https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Domain-ID.html"
QOS = "https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html"
PARAMETERS = "https://docs.ros.org/en/jazzy/Concepts/Basic/About-Parameters.html"
TWIST = "https://docs.ros.org/en/jazzy/p/geometry_msgs/msg/Twist.html"
REP_117 = "https://www.ros.org/reps/rep-0117.html"

MUTATE = "Break that line yourself in a copy of the package, run your tests, and see whether one fails."
ALL_PASS = "Either a failing test asks for more than the contract states, or the package was changed by hand."
SPIN = "Messages arrive only while the executor spins: until(...) has to call spin_once until the condition holds."
SAME_DOMAIN = "The launched program and the test have to be in the same domain: SetEnvironmentVariable comes first."
WAIT = (
    "A program takes a second to start, and its name may be found later than its topics. Wait for both, with a "
    "deadline, before you use them."
)
NO_SLEEP = (
    "A sleep is too long on a fast machine and too short on a busy one.",
    "Wait for a condition, with a deadline: spin_once in a loop until it holds.",
)
