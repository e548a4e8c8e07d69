"""What authors and instructors do with a course: keep it in sync, verify its grader, release it."""
