"""`autograder ros`: runs a command with ROS 2 activated."""

from __future__ import annotations

import os
import shlex
import sys

import click

from autograder.ros.domains import Domain
from autograder.ros.environment import activate, find, path_with_scripts
from autograder.ros.exceptions import RosError


@click.command(context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False})
@click.argument("command", nargs=-1, type=click.UNPROCESSED)
def ros(command: tuple[str, ...]) -> None:
    """Run COMMAND with ROS 2 activated, for example `autograder ros jupyter lab`.

    Without a command, the environment variables are printed as shell code. `eval "$(autograder ros)"` is equivalent to
    sourcing the setup.bash of a ROS installation.

    Unless ROS_DOMAIN_ID is set, COMMAND uses your ROS domain, which your notebooks share and other users do not.
    """
    sys.exit(_run(command))


def _run(command: tuple[str, ...]) -> int:
    """Replace this process by the command, or print the variables. Return the exit status if that fails."""
    try:
        # A command and its child processes keep this domain. If the variables are only printed, nothing reserves it.
        domain = None if os.environ.get("ROS_DOMAIN_ID") else Domain(user=os.getuid())
        number = None if domain is None else domain.number
        if not command:
            for name, value in {**find().variables(domain=number), "PATH": path_with_scripts()}.items():
                click.echo(f"export {name}={shlex.quote(value)}")
            return 0
        activate(domain=number)
        if domain is not None:
            domain.keep_across_exec()
        os.execvp(command[0], command)
    except RosError as error:
        click.echo(f"ROS 2: {error}.", err=True)
        return 1
    except OSError as error:
        click.echo(f"{command[0]}: {error.strerror}", err=True)
        return 127
