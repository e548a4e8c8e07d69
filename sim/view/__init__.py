"""Pictures of worlds and runs, a player of recorded runs, and a live view for JupyterLab.

    >>> from sim.view import show, plot, live

This package does not use pyplot or choose a backend, and `import sim` does not import it.
"""

from typing import TYPE_CHECKING, Any

from sim.view.figures import plot, show
from sim.view.picture import Picture
from sim.view.player import Player
from sim.view.run_data import Margin, encode
from sim.view.theme import DARK, LIGHT, Theme

__all__ = ["DARK", "LIGHT", "LiveView", "Margin", "Picture", "Player", "Theme", "encode", "live", "plot", "show"]

if TYPE_CHECKING:
    from sim.view.live_view import LiveView, live


def __getattr__(name: str) -> Any:
    """Import the live view, and anywidget with it, only when it is used."""
    if name in ("live", "LiveView"):
        from importlib import import_module

        module = import_module("sim.view.live_view")
        return getattr(module, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
