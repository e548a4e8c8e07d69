"""Sentences and pages that several checks refer to."""

PYTEST = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Testing/Python.html"
INTEGRATION = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Testing/Integration.html"
CLI = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Testing/CLI.html"
APPROX = "https://docs.pytest.org/en/stable/reference/reference.html#pytest-approx"
RAISES = "https://docs.pytest.org/en/stable/how-to/assert.html#assertions-about-expected-exceptions"
DOMAIN = "https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Domain-ID.html"
QOS = "https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html"
PARAMETERS = "https://docs.ros.org/en/jazzy/Concepts/Basic/About-Parameters.html"

MUTATE = "Break that line yourself in a copy of the package, run your tests, and see whether one fails."
