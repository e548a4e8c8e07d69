"""The simulator's command line. `python -m sim WORLD` starts it as a ROS 2 node; other commands draw and export."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from sim.exceptions import SimError
from sim.maps import load
from sim.recording import load_recording
from sim.simulation import Simulation, start

_EXISTING_FILE = click.Path(exists=True, dir_okay=False, path_type=Path)
_NEW_FILE = click.Path(dir_okay=False, path_type=Path)
_THEME = click.option("--theme", type=click.Choice(["light", "dark"]), default="light", show_default=True)


class _WorldFirst(click.Group):
    """A group in which the command `run` is optional: a first argument that is not a command is the world."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if args and not args[0].startswith("-") and args[0] not in self.commands:
            args = ["run", *args]
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except SimError as error:
            raise click.ClickException(str(error)) from None


_HELP = """A 2D lidar simulator.

\b
python -m sim WORLD                  run it as the ROS 2 node `simulator`
python -m sim picture WORLD OUT.png  draw a world
python -m sim plot RUN.npz OUT.svg   draw a recorded run
python -m sim export RUN.npz OUT     write it as .gif, .mp4, .html or .mcap
python -m sim teleop                 drive a robot with the keys of this terminal
"""


@click.group(cls=_WorldFirst, help=_HELP, context_settings={"help_option_names": ["-h", "--help"]})
def main() -> None:
    """Group the commands."""


@main.command(context_settings={"ignore_unknown_options": True, "allow_extra_args": True})
@click.argument("world", type=_EXISTING_FILE)
@click.option("--speed", type=click.FloatRange(0.01, 1000.0), default=1.0, show_default=True, help="Times real time.")
@click.option("--robot", "robots", multiple=True, metavar="NAMESPACE", help="A robot's namespace; once for each robot.")
@click.option("--lidar", type=click.Choice(["lds_01", "rplidar_a1", "utm_30lx"]), default="lds_01", show_default=True)
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True)
@click.option("--stamped", is_flag=True, help="Take TwistStamped on cmd_vel instead of Twist.")
@click.option("--paused", is_flag=True, help="Start paused: step with the service /simulator/step.")
@click.pass_context
def run(
    ctx: click.Context,
    world: Path,
    speed: float,
    robots: tuple[str, ...],
    lidar: str,
    seed: int,
    stamped: bool,
    paused: bool,
) -> None:
    """Run WORLD as the ROS 2 node `simulator`, until Ctrl-C.

    Further arguments are passed to ROS: `python -m sim lab.yaml --ros-args -p lidar_noise:=0.01 -r scan:=lidar/scan`.
    """
    from sim.bridge.node import main as run_node

    names = ", ".join(repr(robot) for robot in robots) or "''"
    parameters = (
        f"world:={str(world)!r}",
        f"speed:={speed!r}",
        f"robots:=[{names}]",
        f"lidar:={lidar}",
        f"seed:={seed}",
        f"stamped_cmd_vel:={str(stamped).lower()}",
        f"start_paused:={str(paused).lower()}",
    )
    arguments = [text for parameter in parameters for text in ("-p", parameter)]
    # The user's own arguments are last, so that they have precedence.
    sys.exit(run_node(["--ros-args", *arguments, "--", *ctx.args]))


@main.command()
@click.argument("world", type=_EXISTING_FILE)
@click.argument("picture", type=_NEW_FILE)
@_THEME
@click.option("--scan/--no-scan", default=False, help="Place robots at the start poses, and draw their scans.")
def picture(world: Path, picture: Path, theme: str, scan: bool) -> None:
    """Draw WORLD into PICTURE, a .png or .svg."""
    from sim.view import show

    loaded_world = load(world)
    drawing = show(loaded_world, theme=theme)
    if scan:
        simulation = Simulation(loaded_world)
        drawing = show(simulation, start(simulation), theme=theme)
    _save(drawing, picture)


@main.command()
@click.argument("recording", type=_EXISTING_FILE)
@click.argument("picture", type=_NEW_FILE)
@click.option("--colour", type=click.Choice(["time", "clearance"]), default="time", show_default=True)
@click.option("--mark", type=float, metavar="SECONDS", help="Mark an instant.")
@click.option("--note", default="", help="The text beside the mark.")
@_THEME
def plot(recording: Path, picture: Path, colour: Any, mark: float | None, note: str, theme: str) -> None:
    """Draw the tracks of a saved RECORDING into PICTURE, a .png or .svg."""
    from sim.view import plot as draw

    _save(draw(load_recording(recording), colour=colour, mark=mark, note=note, theme=theme), picture)


@main.command(name="export")
@click.argument("recording", type=_EXISTING_FILE)
@click.argument("out", type=click.Path(path_type=Path))
@click.option("--speed", type=float, help="For a .gif or .mp4: simulated seconds per second.  [default: 1]")
@click.option("--fps", type=float, help="For a .gif or .mp4: frames per second.  [default: 10 or 25]")
def export_(recording: Path, out: Path, **options: float | None) -> None:
    """Write a saved RECORDING as OUT: .gif, .mp4, .html, or .mcap for a rosbag2 folder of that name."""
    from sim.export import export

    given_options = {name: value for name, value in options.items() if value is not None}
    click.echo(export(load_recording(recording), out, **given_options))


@main.command()
@click.option("--robot", "namespace", default="", metavar="NAMESPACE", help="The robot's namespace.")
@click.option("--stamped", is_flag=True, help="Send TwistStamped instead of Twist.")
def teleop(namespace: str, stamped: bool) -> None:
    """Drive a robot with the keys of this terminal, over ROS."""
    from sim.bridge.teleop import drive

    drive(namespace, stamped=stamped)


def _save(drawing: Any, path: Path) -> None:
    try:
        click.echo(drawing.save(path))
    except (OSError, ValueError) as error:
        raise click.ClickException(str(error)) from None


if __name__ == "__main__":
    main(prog_name="python -m sim")
