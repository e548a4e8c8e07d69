"""Forks Python programs into their sandboxes from a process that has already imported their common modules.

A fork server (`server.py`) is a trusted process outside every sandbox. It has imported a profile's modules
(`profiles.py`), and never reads a student's file. Bubblewrap creates the sandbox, as for any command. The server forks
a process, which enters the sandbox, gives up its rights there (`confinement.py`), and then becomes the program
(`emulation.py`). The program's children can be forked as well (`children.py`). `client.py` is the grader's end.
"""
