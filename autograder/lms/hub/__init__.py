"""A JupyterHub for a class on one machine: its configuration, its spawner, and a trial hub (`make hub`).

Only the hub's own process imports the spawner, because JupyterHub is an optional dependency.
"""
