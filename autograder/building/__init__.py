"""Builds a student's packages with colcon, in a sandbox without a network.

`build` builds the packages that a suite requires. If a failed build does not end the grading, the checks get the
outcome of each package. `interface_bundle` takes a submission's message packages from the cache of builds.
"""
