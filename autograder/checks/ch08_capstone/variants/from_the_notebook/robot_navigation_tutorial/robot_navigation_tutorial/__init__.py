"""Reactive navigation in three nodes."""
