"""The dancer, started as `ros2 run` starts it."""

from __future__ import annotations

import random

import yaml

from autograder.checks import check, expect
from autograder.lab import Workspace
from autograder.probes.installed import Installed
from autograder.visible.ch01_package_structure import contract, robots

GROUP = "run"
HINTS = (
    "ros2 run square_dance dancer in a new shell, after source install/setup.bash: what does it print?",
    "An entry point reads name = package.folder.module:function.",
)


@check(points=2, group=GROUP, depends=("executable", "subpackages"), hints=HINTS, doc=contract.CREATE)
def test_starts(workspace: Workspace) -> None:
    """`ros2 run square_dance dancer` starts a node called dancer."""
    with robots.dancer(workspace) as lab:
        names = lab.nodes()
    expect("/dancer" in names, f"The graph holds {', '.join(names) or 'no node'}, but no /dancer.")


@check(points=1, group=GROUP, depends=("starts",), hints=HINTS, doc=contract.CREATE)
def test_dances(workspace: Workspace, draw: random.Random) -> None:
    """It drives along a side of the square, and then turns to the left."""
    side = round(draw.uniform(0.5, 1.5), 2)
    with robots.dancer(workspace, "-p", f"side:={side}") as lab:
        robots.expect_dance(lab, side)


@check(
    points=1,
    group=GROUP,
    depends=("starts", "config"),
    hints=("The configuration is given: install it as it is.", "It belongs to the node dancer, and sets side."),
    doc=contract.DEVELOP,
)
def test_configured(workspace: Workspace, dance: Installed) -> None:
    """With the installed configuration it dances a square of the size that is written there."""
    path = dance.prefix / "share" / dance.package / contract.DANCE_CONFIG
    side = _side(dance.read(contract.DANCE_CONFIG) or b"")
    with robots.dancer(workspace, "--params-file", str(path)) as lab:
        robots.expect_dance(lab, side)


def _side(text: bytes) -> float:
    try:
        side = yaml.safe_load(text)["dancer"]["ros__parameters"]["side"]
    except (yaml.YAMLError, KeyError, TypeError, ValueError, RecursionError):
        side = None
    usable = isinstance(side, float) and 0.1 <= side <= 5.0
    expect(usable, "The configuration does not set dancer: ros__parameters: side to a length in metres, such as 1.5.")
    return float(side or 0.0)
