"""Rules over time, judged on a recorded run. A module of its own, because rtamt is slow to import."""

from autograder.suite.temporal import Verdict, always

__all__ = ["Verdict", "always"]
