"""Probes: each finds out one thing about a package without importing its code. Checks are made of them."""

from pathlib import Path

PRELOAD = Path(__file__).with_name("preload.py")
"""What may have been imported before a student's tests or functions are (see `sandbox.zygote`)."""
