"""Modules that inspect a student's package or running program, such as `parameters` or `linters`.

A module is imported on first use, so that a grading loads only the modules that its checks use.
"""

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from autograder.probes import (
        added_files,
        calls,
        colcon_test,
        fault_injection,
        files,
        given_files,
        imports,
        installed,
        interfaces,
        late_joiner,
        launch_arguments,
        launch_probe,
        linters,
        manifest,
        message_period,
        namespaces,
        node_callbacks,
        packaging,
        parameters,
        programs,
        qos,
        rclpy_races,
        short_lived,
        student_test_reports,
        student_test_runs,
        student_yaml,
        versions,
    )

__all__ = [
    "added_files",
    "calls",
    "colcon_test",
    "fault_injection",
    "files",
    "given_files",
    "imports",
    "installed",
    "interfaces",
    "late_joiner",
    "launch_arguments",
    "launch_probe",
    "linters",
    "manifest",
    "message_period",
    "namespaces",
    "node_callbacks",
    "packaging",
    "parameters",
    "programs",
    "qos",
    "rclpy_races",
    "short_lived",
    "student_test_reports",
    "student_test_runs",
    "student_yaml",
    "versions",
]


def __getattr__(name: str) -> ModuleType:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return import_module(f"autograder.probes.{name}")
