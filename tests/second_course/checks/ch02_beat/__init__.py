"""The checks of 02_beat."""
