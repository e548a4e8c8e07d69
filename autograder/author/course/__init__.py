"""Keeps notebooks and reference solutions in sync, checks the notebooks, and executes them.

`solutions/` is the single source. The metadata of cells and notebooks name the files that they copy (`cells`). `sync`
writes the copies and finds outdated ones. `execute` executes a notebook in one of its `forms`: source, solved or
released.
"""
