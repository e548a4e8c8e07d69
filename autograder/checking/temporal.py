"""Evaluates temporal rules on a recorded run. This is a separate module, because rtamt is slow to import."""

from autograder.suite.temporal import Verdict, always

__all__ = ["Verdict", "always"]
