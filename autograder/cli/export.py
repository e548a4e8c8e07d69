"""`autograder export`: stored results in other programs' formats."""

from __future__ import annotations

from pathlib import Path

import click

from autograder import export as exporters
from autograder.cli.options import json_option
from autograder.result import write_json

_FOLDERS = " and ".join(name for name, format in exporters.FORMATS.items() if format.FOLDER)


@click.command()
@click.argument("results", type=click.Path(path_type=Path))
@click.option(
    "--format", "name", required=True, type=click.Choice(list(exporters.FORMATS)), help="The format to write."
)
@click.option(
    "--out",
    required=True,
    type=click.Path(path_type=Path),
    help=f"The file to write. For {_FOLDERS}, it is the folder.",
)
@json_option
def export(results: Path, name: str, out: Path, json_file: Path | None) -> None:
    """Write stored RESULTS (a folder or a JSON file) as marks for other programs."""
    stored = exporters.load(results)
    written = exporters.write(stored, name, out)
    click.echo(f"{len(stored)} results: {written}")
    if json_file is not None:
        write_json(json_file, {"results": len(stored), "format": name, "written": str(written)})
