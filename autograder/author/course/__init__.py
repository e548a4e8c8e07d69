"""Keeps the notebooks and the reference solutions equal, checks the notebooks and executes them.

`solutions/` is the single source. The metadata of a cell or a notebook names the files that it copies (`cells`).
`sync` writes the copies and finds the outdated ones. `execute` executes one of the `forms` of a notebook: the source,
the solved or the released one.
"""
