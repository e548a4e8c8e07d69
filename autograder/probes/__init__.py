"""What checks are made of: one probe an idea, each a way to learn something of a package without importing its code."""

from pathlib import Path

PRELOAD = Path(__file__).with_name("preload.py")
"""What may have been imported before a student's tests or functions are (see `sandbox.zygote`)."""
