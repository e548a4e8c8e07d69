"""A JupyterHub for a class on one machine: its configuration, its spawner, and a hub for trying (`make hub`).

The spawner is for the hub's own process. Nothing else imports it, since JupyterHub is an extra.
"""
