"""The chapters' checks: one package for each chapter.

The package of a chapter::

    chNN_name/
        conftest.py    the fixtures of this chapter
        support/       contract, robots and stimuli: what visible and hidden checks share
        visible/       the checks that students run themselves
        hidden/        the checks that grade; students never get this folder
        mutants.yaml   flawed versions of the reference, each with the check for which it was written
        variants/      right answers in another style
        attacks.py     optional: submissions that try to get points that they have not earned

Visible checks and support import nothing hidden, and no conftest imports another. The release and the sandbox hold no
`hidden` folder. The fixtures that every chapter has are those of `autograder.grade.plugin`.
"""

from autograder import layout

# The chapters of a course that lies elsewhere are imported under the same names, as autograder.checks.chID.
if str(layout.CHECKS) not in __path__:
    __path__.insert(0, str(layout.CHECKS))
