"""The page `benchmarks.md`, generated from `benchmarks.yaml` and the record of `make bench`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import yaml

from autograder.author.course.markdown_table import table
from autograder.course_paths import ROOT

FIGURES: dict[str, dict[str, Any]] = yaml.safe_load((ROOT / "docs" / "benchmarks.yaml").read_text(encoding="utf-8"))
RECORD = ROOT / ".build" / "bench.json"
NO_RECORD: dict[str, dict[str, Any]] = {"figures": {}, "machine": {}}
# A figure has the unit of the first ending that matches its name.
UNITS = {
    "_core_s": "core-seconds",
    "_per_s": "per second",
    "_per_minute_02": "per minute",
    "_per_minute_08": "per minute",
    "_us": "µs",
    "_ms": "ms",
    "_s": "s",
    "_mb": "MiB",
    "_rtf": "times real time",
    "_ratio": "times",
    "_capstone": "times",
}
HEAD = """# Benchmarks

`make bench` measures these figures and writes them to `.build/bench.json`. `make docs` writes this page from that file.
The last figure takes several minutes, so only `make bench BENCH_ARGS=first_robots` measures it. Caches are warm unless
the table says otherwise. Core-seconds are the processor time of the whole machine, so nothing else should run on it.
"""
MEASURED = "The figures were measured on this machine: {}.\n"
NOT_MEASURED = "This site was built without that file, so the table shows no measured figures.\n"
FOOT = """
Figures of other programs without an asterisk were measured in the same run as ours. Those with an asterisk were
measured earlier, on one core of another machine. ir-sim and shapely compute exact ranges, as `sim` does. f1tenth_gym
and range_libc look ranges up in a grid, so half of their ranges are wrong by 3 cm or more. For a run, the other
simulators' steps per second are divided by ten, because ours has ten scans per simulated second.
"""


def page(record: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the page for a record as Markdown."""
    figures, machine = record["figures"], record["machine"]
    rows = [
        (f"`{name}`", figure["what"], _text(figures.get(name), _unit(name)), _beside(name, figure, figures))
        for name, figure in FIGURES.items()
    ]
    origin = MEASURED.format(", ".join(f"{key} {value}" for key, value in machine.items())) if machine else NOT_MEASURED
    return "\n".join(
        [HEAD, origin, *table(("figure", "what is measured", "measured", "others"), rows), FOOT.strip() + "\n"]
    )


def current() -> str:
    """Return the page for the record of the last `make bench`, or without measured figures if it has not been run."""
    return page(json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.is_file() else NO_RECORD)


def _unit(name: str) -> str:
    return next(unit for ending, unit in UNITS.items() if name.endswith(ending))


def _beside(name: str, figure: Mapping[str, Any], figures: Mapping[str, float]) -> str:
    """Return the figures of other programs. An asterisk marks those that `make bench` does not measure."""
    texts = {
        program: _text(figures.get(value), _unit(name)) if isinstance(value, str) else f"{_text(value, _unit(name))}\\*"
        for program, value in figure.get("beside", {}).items()
    }
    return "; ".join(f"{program}: {text}" for program, text in texts.items() if text)


def _text(value: float | None, unit: str) -> str:
    """Return a figure with three significant digits, or all digits of its integer part, and its unit."""
    if value is None:
        return ""
    return f"{value:,.0f} {unit}" if abs(value) >= 100 else f"{value:.3g} {unit}"
