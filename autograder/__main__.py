"""Runs the command `autograder` as `python -m autograder`."""

from autograder.cli import main

main()
