"""The hidden suite of 06_testing: do a student's tests pass on what is right, and fail on what is not?"""

PACKAGES = ("speed_guard",)
MODULES = ("function", "node", "launch", "quality")
READS = ("solutions/speed_guard",)  # the versions that tests meet are made from it
