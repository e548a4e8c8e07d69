"""The chapter prints no text for this file."""
