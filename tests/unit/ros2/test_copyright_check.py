"""The stand-in for ament_copyright."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from autograder.ros.ros2.pkg_templates import LICENCE_TEXTS, licence_text
from autograder.ros.standins.ament_copyright.headers import Header, licence_of_text, parse_header
from autograder.ros.standins.ament_copyright.main import main

APACHE = """# Copyright 2024-2026 Ada Lovelace
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
"""


@pytest.mark.parametrize(
    ("text", "comment", "header"),
    [
        (APACHE, "#", Header(("2024-2026 Ada Lovelace",), "Apache-2.0")),
        (
            "#!/usr/bin/env python3\n# -*- coding: utf-8 -*-\n\n" + APACHE,
            "#",
            Header(("2024-2026 Ada Lovelace",), "Apache-2.0"),
        ),
        ("# Copyright (c) 2026, Ada\n# SPDX-License-Identifier: MIT\n", "#", Header(("2026 Ada",), "MIT")),
        ("// Copyright 2026 Ada\n// Copyright 2025 Bo\n", "//", Header(("2026 Ada", "2025 Bo"), "<unknown>")),
        (
            "/* Copyright 2026 Ada\n * SPDX-License-Identifier: BSL-1.0\n */\nint x;\n",
            "//",
            Header(("2026 Ada",), "BSL-1.0"),
        ),
        ("import os\n" + APACHE, "#", Header((), "<unknown>")),
        ("# Copyright Ada\n", "#", Header((), "<unknown>")),
    ],
)
def test_the_first_comment_names_holder_and_licence_of_a_file(text: str, comment: str, header: Header) -> None:
    assert parse_header(text.splitlines(), comment=comment) == header


@pytest.mark.parametrize("identifier", sorted(set(LICENCE_TEXTS) - {"BSD-2.0"}))
def test_each_text_that_pkg_create_writes_is_recognised(identifier: str) -> None:
    text = licence_text(identifier, "Ada Lovelace", 2026)
    assert text is not None
    assert licence_of_text(text) == identifier
    assert "{" not in text


def test_a_folder_is_searched_for_source_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "package.xml").write_text("<package/>")
    (tmp_path / "setup.py").write_text("not checked beside package.xml")
    (tmp_path / "LICENSE").write_text(licence_text("MIT", "Ada", 2026) or "")
    for folder in ("code", ".git", "_cache"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "x.py").write_text(APACHE + "x = 1\n")
    (tmp_path / "code" / "__init__.py").write_text("")
    assert main([str(tmp_path)]) == 0
    assert capsys.readouterr().out == "No problems found, checked 3 files\n"
    (tmp_path / "code" / "bare.py").write_text("x = 1\n")
    (tmp_path / "code" / "odd.cpp").write_text("// Copyright 2026 Ada\nint x;\n")
    assert main([str(tmp_path)]) == 1
    errors = capsys.readouterr().err
    assert f"{tmp_path}/code/bare.py: could not find copyright notice\n" in errors
    assert f"{tmp_path}/code/odd.cpp: copyright=2026 Ada, license=<unknown>\n" in errors
    assert errors.endswith("2 errors, checked 5 files\n")
    assert main([str(tmp_path), "--exclude", "bare.py", "odd.cpp"]) == 0


def test_a_missing_file_and_a_binary_file_are_errors(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bad.py").write_bytes(b"\xff\xfe")
    assert main([str(tmp_path)]) == 1
    assert "bad.py: cannot be read as text" in capsys.readouterr().err


def test_the_results_can_be_written_as_xunit(tmp_path: Path) -> None:
    (tmp_path / "bare.py").write_text("x = 1\n")
    report = tmp_path / "out" / "copyright.xunit.xml"
    assert main([str(tmp_path / "bare.py"), "--xunit-file", str(report)]) == 1
    suite = ET.parse(report).getroot()
    assert (suite.get("name"), suite.get("tests"), suite.get("failures")) == ("out.copyright", "1", "1")
    failure = suite.find("testcase/failure")
    assert failure is not None
    assert failure.get("message") == "could not find copyright notice"


def test_known_licences_can_be_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--list-licenses"]) == 0
    assert "Apache-2.0" in capsys.readouterr().out.split()


def test_a_missing_source_file_is_not_a_problem(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path)]) == 0
    assert capsys.readouterr().out.startswith("No repository roots and files found\n")
