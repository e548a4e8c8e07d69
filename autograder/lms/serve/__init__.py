"""The service of a JupyterHub that grades what students hand in, as they hand it in.

    submit(...) -> handlers -> store (on disk, then acknowledged) -> queue (whose turn it is) -> grading -> pages

`queue` and `settings` decide, and touch nothing. `store` alone writes. The process may be killed at any instant: what
was acknowledged is graded, once.
"""
