"""The service of a JupyterHub that grades students' submissions as they arrive.

    submit(...) -> handlers -> store (on disk, then acknowledged) -> queue (whose turn it is) -> grading -> pages

`queue` and `settings` are pure, and only `store` writes. The process may be killed at any instant: every acknowledged
answer is graded, once.
"""
