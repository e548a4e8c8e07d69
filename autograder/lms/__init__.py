"""The exchange with learning management systems: reads their downloads and writes their tables of marks.

download (zip or folder) -> names -> match with the roster -> the newest of each student -> submissions to grade
results, points of a person, extensions -> the table that the system exported, with the marks filled in
results -> the zip of feedback that the system gives to the students
"""
