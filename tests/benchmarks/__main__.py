"""Run benchmarks, print the machine and a table, and write `.build/bench.json`: `python -m tests.benchmarks [NAME...]`.

A benchmark is a module `bench_NAME.py` in this folder with a function `figures() -> dict[str, float]`. The figures
are described in `docs/benchmarks.yaml`.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import platform
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
ON_REQUEST = ("first_robots",)  # these take several minutes, so they run only if they are named
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


def add_to_record(record: dict[str, Any], figures: dict[str, float], machine: dict[str, str | int]) -> dict[str, Any]:
    """Return a record with new figures. Earlier figures are kept if they were measured on the same machine."""
    earlier_figures = record["figures"] if record.get("machine") == machine else {}
    return {"figures": {**earlier_figures, **figures}, "machine": machine}


def main() -> None:
    """Run the chosen benchmarks; print and write their figures."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks", description="Run the benchmarks.")
    on_request = ", ".join(ON_REQUEST)
    default = f"by default all except {on_request}, which takes several minutes"
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"which to run, {default}: {', '.join(names())}")
    chosen_names = parser.parse_args().names or [name for name in names() if name not in ON_REQUEST]
    if unknown_names := sorted(set(chosen_names) - set(names())):
        parser.error(f"unknown benchmark: {', '.join(unknown_names)}; choose from {', '.join(names())}")
    this_machine, figures = machine(), dict[str, float]()
    for key, text in this_machine.items():
        print(f"{key:36} {text}", flush=True)
    for name in chosen_names:
        results = importlib.import_module(f"tests.benchmarks.bench_{name}").figures()
        for figure, value in results.items():
            print(f"{figure:36} {value:12.4g}", flush=True)
        figures |= results
    record = json.loads(TARGET.read_text(encoding="utf-8")) if TARGET.exists() else {}
    TARGET.parent.mkdir(exist_ok=True)
    text = json.dumps(add_to_record(record, figures, this_machine), indent=2)
    TARGET.write_text(f"{text}\n", encoding="utf-8")
    print(f"written to {TARGET}")


if __name__ == "__main__":
    main()
