"""Building: a student's packages by colcon, in a sandbox that has no network.

`build` builds what a suite wants, and tells checks what became of each package where a failed build does not end the
grading. `interface_bundle` takes a submission's message packages from the cache of builds.
"""
