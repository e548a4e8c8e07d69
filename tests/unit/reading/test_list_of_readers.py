"""The list of readers is complete: each parsing module of the worker is in it, or parses only the grader's own data."""

from __future__ import annotations

import re

from autograder.course_paths import ROOT

PARSES = re.compile(
    r"json\.loads?\(|yaml\.(?:safe_)?load|SafeLoader\(|ET\.(?:fromstring|parse)\(|ast\.parse\(|literal_eval|nbformat\.reads?\("
    r"|\.read_string\(|HeaderParser\(|struct\.unpack|tarfile\.open|\.frombuf\(|zipfile\.ZipFile\(|parse_package_string\(|rosidl_adapter\b"
)
PARTS = ("building", "checks", "grade", "harness", "probes", "run/lockstep", "submission", "suite")
# Modules whose reader is tested, with the reader's name.
TRIED = {
    "checks/ch01_package_structure/hidden/run.py": "configuration of 01",
    "grade/run_notebook.py": "outputs of a notebook",
    "submission/intake/archives.py": "archive",
    "submission/intake/tar.py": "tar",
    "submission/intake/zip_directory.py": "archive",
    "submission/intake/notebooks.py": "cells of a notebook",
    "building/interfaces/cdr.py": "bytes of a message of the student's own type",
    "building/interfaces/rosidl.py": "definition that is built",
    "run/lockstep/protocol.py": "event of a stepped program",
    "submission/packages.py": "package.xml by its name",
    "probes/calls.py": "answer of a function",
    "probes/files.py": "imports of a module",
    "probes/given_files.py": "given file",
    "probes/installed.py": "metadata of an installed package",
    "probes/interfaces.py": "definition of a message",
    "probes/manifest.py": "package.xml whole",
    "probes/parameters.py": "parameter file",
    "probes/student_test_reports.py": "report of pytest",
    "probes/student_yaml.py": "parameter file",
}
# Modules that parse only data of the grader or of a course's author, or that run in the sandbox.
OWN = {
    *("building/interface_bundle.py", "checks/ch06_testing/hidden/faults.py", "suite/contract.py"),
    *("grade/batch.py", "grade/job.py", "grade/notebook_runner.py", "building/bundle_server.py"),
    *("grade/store.py", "building/interfaces/generate.py", "building/interfaces/tutorials.py"),
    *("run/lockstep/lockstep_host/pipes.py", "probes/call_runner.py", "probes/versions.py"),
    "submission/reading.py",  # an example in its docstring
    "grade/bounded_json.py",  # replies of workers, with limits of their own
}


def test_each_parsing_module_of_the_worker_is_tested_with_bad_data() -> None:
    from tests.unit.reading.readers import READERS

    package = ROOT / "autograder"
    files = [path for part in PARTS for path in (package / part).rglob("*.py")]
    excluded = {"variants", "versions"}  # answers, and packages under test
    parsing = {
        path.relative_to(package).as_posix()
        for path in files
        if not excluded & set(path.parts) and path.name != "attacks.py" and PARSES.search(path.read_text())
    }
    assert parsing == {*TRIED, *OWN}
    assert set(TRIED.values()) <= set(READERS)
