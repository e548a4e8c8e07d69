"""The checks of 00_welcome."""
