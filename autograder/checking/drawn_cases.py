"""Tests a rule with cases that Hypothesis draws. This is a separate module, because Hypothesis is slow to import."""

from autograder.suite.drawn_cases import expect_each

__all__ = ["expect_each"]
