"""The checks of 01_greeting."""
