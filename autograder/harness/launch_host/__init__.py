"""The processes around a `ros2` in a sandbox; run as a script, which imports of the grader what `ros2` is."""
