"""The guide to the simulator: its examples run, and it names each parameter of the node and only verbs that exist."""

from __future__ import annotations

import re
import runpy
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sim.__main__ import main
from sim.bridge.settings import SETTINGS

DOCS = Path(__file__).resolve().parents[3] / "docs"
SCRIPT = runpy.run_path(str(DOCS / "build_site.py"))
TEXT = (DOCS / "simulator.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_examples_run_and_draw_the_pictures_that_the_guide_shows(tmp_path: Path) -> None:
    for name in ("simulator.md", "kitchen.yaml"):
        shutil.copy(DOCS / name, tmp_path)
    SCRIPT["run_examples"](tmp_path / "simulator.md")
    pictures = re.findall(r"!\[[^\]]+\]\((\S+)\)", TEXT)
    assert pictures
    assert all((tmp_path / name).is_file() for name in pictures)


@pytest.mark.slow
def test_the_environment_of_the_guide_ends_at_a_collision_or_after_a_minute(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(DOCS)
    (code,) = (code for code in SCRIPT["EXAMPLE"].findall(TEXT) if "import gymnasium" in code)
    names: dict[str, Any] = {}
    exec(code, names)
    for action, end in (((1.0, 0.0), (-10.0, True, False)), ((-1.0, 1.0), (0.0, False, True))):
        environment = names["Kitchen"]()
        environment.reset(seed=1)
        over = False
        while not over:
            _, *result, _ = environment.step(np.array(action, np.float32))
            over = any(result[1:])
        assert tuple(result) == end
    assert environment.state.time_ns == 60_000_000_000


def test_the_guide_names_exactly_the_parameters_of_the_node() -> None:
    parameters = {setting.name for setting in SETTINGS}
    assert parameters - set(re.findall(r"[`\s](\w+)(?:`|:=)", TEXT)) == set()
    assert set(re.findall(r"-p (\w+):=", TEXT)) <= parameters


def test_the_commands_of_the_guide_use_existing_verbs_and_options() -> None:
    commands = re.findall(r"^\$ python -m sim (.*?)(?: --ros-args.*)?$", TEXT, re.MULTILINE)
    assert len(commands) > 8
    verbs = main.commands
    for command in commands:
        name, *words = command.split()
        verb = verbs.get(name, verbs["run"])
        options = {option for parameter in verb.params for option in parameter.opts}
        assert {word for word in words if word.startswith("--")} <= options, command
