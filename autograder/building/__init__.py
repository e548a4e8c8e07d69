"""Builds a student's packages with colcon, in a sandbox without a network.

`build` builds the packages that a suite requires, and reports the outcome of each package to checks if a failed build
does not end the grading. `interface_bundle` takes a submission's message packages from the cache of builds.
"""
