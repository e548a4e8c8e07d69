"""The exchange with learning management systems: what they hand over, and what they take back.

download (zip or folder) -> names -> match with the roster -> the newest of each student -> submissions to grade
results -> the table that the system exported, with the marks filled in
"""

from autograder.lms.collect import HANDED_IN, Collected, collect, unpacked
from autograder.lms.marks import SYSTEMS, write_marks
from autograder.lms.roster import Roster, read_roster

__all__ = ["HANDED_IN", "SYSTEMS", "Collected", "Roster", "collect", "read_roster", "unpacked", "write_marks"]
