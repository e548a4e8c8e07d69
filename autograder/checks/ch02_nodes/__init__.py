"""The checks of 02_nodes."""
