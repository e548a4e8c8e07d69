"""Tools for the authors and instructors of a course: keep it in sync, verify its grader, release it."""
