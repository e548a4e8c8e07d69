"""Probes inspect a student's package or running program for checks, and never import the student's code here."""
