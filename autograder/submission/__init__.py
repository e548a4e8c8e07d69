"""What was handed in: read within bounds, its ROS packages found, its unfinished files named."""
