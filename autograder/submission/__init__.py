"""Submissions: reads them within bounds, finds their ROS packages, and names unfinished files."""
