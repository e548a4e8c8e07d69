"""The chapters' checks: one package for each chapter.

The package of a chapter::

    chNN_name/
        conftest.py    the fixtures of this chapter
        support/       contract, robots and stimuli for visible and hidden checks
        visible/       the checks that students run themselves
        hidden/        the checks that grade; students never get this folder
        mutants.yaml   flawed versions of the reference, each with the check for which it was written
        variants/      right answers in another style
        attacks.py     optional: submissions that try to get points that they have not earned

All of them import nothing of the autograder except `autograder.checking` and modules of their own or another chapter.
Visible checks and support import nothing hidden, and no conftest imports another. Releases and sandboxes contain no
`hidden` folder. Every chapter has the fixtures of `autograder.grade.plugin`.
"""

from autograder import course_paths

# The chapters of another course's folder are imported under the same names, as autograder.checks.chID.
if str(course_paths.CHECKS) not in __path__:
    __path__.insert(0, str(course_paths.CHECKS))
