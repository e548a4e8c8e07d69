"""Draw each world of assets/worlds into assets/figures/worlds: `python assets/figures/make_worlds.py`.

The same worlds give the same bytes, so that a figure changes in git only when its world does.
"""

from __future__ import annotations

from pathlib import Path

from sim.maps import load
from sim.view import Picture, show

ASSETS = Path(__file__).resolve().parents[1]


def figures() -> dict[Path, Picture]:
    """Return each world's picture by the path it belongs to."""
    worlds = sorted((ASSETS / "worlds").glob("*.yaml"))
    return {ASSETS / "figures" / "worlds" / f"{path.stem}.png": show(load(path)) for path in worlds}


def main() -> None:
    """Write the pictures."""
    for path, picture in figures().items():
        path.parent.mkdir(parents=True, exist_ok=True)
        print(picture.save(path).relative_to(ASSETS.parent))


if __name__ == "__main__":
    main()
