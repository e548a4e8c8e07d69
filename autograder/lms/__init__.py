"""The exchange with learning management systems: reads their downloads and writes their tables of marks.

download (zip or folder) -> names -> match with the roster -> each student's newest attempt -> submissions to grade
results, manual points, extensions -> the table that the system exported, with the marks filled in
results -> the zip of feedback that the system returns to the students
"""
