"""The record of `make bench` contains figures of one machine."""

from __future__ import annotations

from tests.benchmarks.__main__ import ON_REQUEST, add_to_record, machine, names

MACHINE: dict[str, str | int] = {"processor": "Z80", "cores": 1}
RECORD = {"figures": {"a_s": 1.0, "b_s": 2.0}, "machine": MACHINE}


def test_new_figures_replace_earlier_ones_and_the_others_are_kept() -> None:
    assert add_to_record(RECORD, {"b_s": 3.0}, MACHINE) == {"figures": {"a_s": 1.0, "b_s": 3.0}, "machine": MACHINE}


def test_figures_of_another_machine_are_dropped() -> None:
    other: dict[str, str | int] = {"processor": "Z80", "cores": 2}
    assert add_to_record(RECORD, {"b_s": 3.0}, other) == {"figures": {"b_s": 3.0}, "machine": other}
    assert add_to_record({}, {"b_s": 3.0}, other) == {"figures": {"b_s": 3.0}, "machine": other}


def test_the_machine_has_a_processor_cores_a_system_and_a_python() -> None:
    assert all(machine()[key] for key in ("processor", "cores", "system", "python"))


def test_benchmarks_on_request_exist() -> None:
    assert set(ON_REQUEST) < set(names())
