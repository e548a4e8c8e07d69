"""The service of a JupyterHub that grades students' submissions as they arrive.

    submit(...) -> handlers -> store (on disk, then acknowledged) -> queue (whose turn it is) -> grading -> pages

`queue` and `settings` have no side effects. The process may be killed at any time. Each acknowledged answer is graded
exactly once.
"""
