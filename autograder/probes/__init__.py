"""Probes inspect a student's package or running program; checks call them. None imports the student's code here."""
