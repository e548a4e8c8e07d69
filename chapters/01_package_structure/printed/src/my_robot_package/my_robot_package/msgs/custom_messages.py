"""The chapter prints no text for this file; messages are not written in Python."""
