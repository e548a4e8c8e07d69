"""Reactive navigation in three nodes: one sees, one drives, one watches the other two."""
