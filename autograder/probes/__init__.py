"""Probes: each finds out one thing about a package without importing its code. Checks are made of them."""
