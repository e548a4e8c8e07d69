"""The chapters' checks: one package for each chapter.

The package of a chapter::

    chNN_name/
        conftest.py    the fixtures of this chapter
        support/       the contract, harnesses and inputs that visible and hidden checks share
        visible/       the checks that students run themselves
        hidden/        the checks that decide the points; students never get this folder
        mutants.yaml   flawed versions of the reference, each with the check for which it was written
        variants/      correct answers in another style
        attacks.py     optional: submissions that try to get points that they have not earned

From the autograder, they import only `autograder.checking` and modules of their own chapter or another one.
Visible checks and support import nothing hidden, and no conftest imports another. Releases and sandboxes contain no
`hidden` folder. Every chapter has the fixtures of `autograder.grade.plugin`.
"""

from autograder import course_paths

# Chapters in another course's folder are imported under the same names, as autograder.checks.chID.
if str(course_paths.CHECKS) not in __path__:
    __path__.insert(0, str(course_paths.CHECKS))
