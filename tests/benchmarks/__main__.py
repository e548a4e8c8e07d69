"""Run every benchmark, print a table, and write `.build/bench.json`: `python -m tests.benchmarks [NAME...]`.

A benchmark is a module `bench_NAME.py` in this folder with a function `figures() -> dict[str, float]`.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import platform
from pathlib import Path

HERE = Path(__file__).parent
TARGET = HERE.parents[1] / ".build" / "bench.json"


def names() -> list[str]:
    """Return the names of all benchmarks."""
    return sorted(path.stem.removeprefix("bench_") for path in HERE.glob("bench_*.py"))


def machine() -> dict[str, str | int]:
    """Describe the machine on which the figures are measured."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return {
        "processor": models[0] if models else platform.processor(),
        "cores": os.cpu_count() or 1,
        "system": platform.platform(),
        "python": platform.python_version(),
    }


def main() -> None:
    """Run the chosen benchmarks; print and write their figures."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks", description="Run the benchmarks.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"which to run, all by default: {', '.join(names())}")
    chosen_names = parser.parse_args().names or names()
    if unknown_names := sorted(set(chosen_names) - set(names())):
        parser.error(f"unknown benchmark: {', '.join(unknown_names)}; choose from {', '.join(names())}")
    figures: dict[str, float] = {}
    for name in chosen_names:
        results = importlib.import_module(f"tests.benchmarks.bench_{name}").figures()
        for figure, value in results.items():
            print(f"{figure:32} {value:12.4g}", flush=True)
        figures |= results
    if set(chosen_names) != set(names()) and TARGET.exists():  # keep the figures of the benchmarks that did not run
        figures = {**json.loads(TARGET.read_text(encoding="utf-8"))["figures"], **figures}
    TARGET.parent.mkdir(exist_ok=True)
    TARGET.write_text(json.dumps({"figures": figures, "machine": machine()}, indent=2) + "\n", encoding="utf-8")
    print(f"written to {TARGET}")


if __name__ == "__main__":
    main()
