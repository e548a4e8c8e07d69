"""The proof of the grader: submissions whose mark is known beforehand, and what grading makes of them.

For each assignment: the reference has every point and the untouched release none; right answers in another style keep
every point; each named mutant loses the checks that it names and no other; mutants made by operators lose something;
no attack gains a point.
"""

from autograder.proof.cases import Case, cases
from autograder.proof.claims import Claim, Kind
from autograder.proof.prove import prove
from autograder.proof.summary import holds, summary

__all__ = ["Case", "Claim", "Kind", "cases", "holds", "prove", "summary"]
