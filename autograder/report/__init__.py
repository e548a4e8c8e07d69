"""Presents results: feedback pages for people, and exports for other programs."""
