"""A suite says whether its checks are run when the build failed."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from autograder.suite import suites


@pytest.mark.parametrize(("line", "expected"), [("", False), ("BUILD_MAY_FAIL = True\n", True)])
def test_a_build_may_fail_only_if_the_suite_allows_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, line: str, expected: bool
) -> None:
    home = f"home_{expected}".lower()
    package = tmp_path / home / "ch00_example" / "hidden"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text(f"PACKAGES = ('a',)\nMODULES = ()\n{line}")
    for folder in (package.parent, package.parent.parent):
        (folder / "__init__.py").write_text("")
    monkeypatch.syspath_prepend(tmp_path)
    assert suites.read(home, "00_example", suites.HIDDEN).build_may_fail is expected
    sys.modules.pop(home)
