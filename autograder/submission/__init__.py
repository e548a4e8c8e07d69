"""Reads submissions within limits, finds their ROS packages, and names unfinished files."""
