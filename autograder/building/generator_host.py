"""One of rosidl's code generators, which parses no file that another has parsed: what CMake starts in its place.

To build one interface package, six generators run, each a program of its own. Each parses the same .idl files, with a
parser that takes a tenth of a second for one. Here what was parsed is kept for the next of them. What they write is
what they always write.

It runs inside the sandbox of a build, and what is kept lies there: it is no less the student's to harm.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import runpy
import sys
from importlib import import_module
from pathlib import Path
from typing import Any


def run(generator: Path, parsed: Path) -> None:
    """Be a generator.

    Args:
        generator: rosidl's own program; its command line is in `sys.argv`.
        parsed: the folder of what was parsed in this build.
    """
    _remember_parsing(parsed)
    sys.argv[0] = str(generator)
    sys.path[0] = str(generator.parent)
    runpy.run_path(str(generator), run_name="__main__")


def _remember_parsing(folder: Path) -> None:
    parser = import_module("rosidl_parser.parser")
    original = parser.parse_idl_string

    def parse_idl_string(text: str, png_file: str | None = None) -> Any:
        kept = folder / hashlib.sha256(text.encode()).hexdigest()
        if kept.is_file():
            return pickle.loads(kept.read_bytes())
        content = original(text, png_file=png_file)
        folder.mkdir(parents=True, exist_ok=True)
        whole = kept.with_suffix(f".{os.getpid()}")
        whole.write_bytes(pickle.dumps(content))
        whole.replace(kept)  # make runs generators side by side
        return content

    parser.parse_idl_string = parse_idl_string  # type: ignore[attr-defined]
