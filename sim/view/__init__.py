"""Pictures of worlds and runs, and a live view for JupyterLab.

    >>> from sim.view import show, plot, live

Nothing here touches pyplot or chooses a backend; `import sim` does not import it.
"""

from sim.view.figures import plot, show
from sim.view.picture import Picture
from sim.view.theme import DARK, LIGHT, Theme

__all__ = ["DARK", "LIGHT", "Picture", "Theme", "plot", "show"]
