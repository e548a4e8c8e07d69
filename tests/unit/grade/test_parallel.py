"""Items are processed in parallel: results keep their order, and no item is started after an error."""

from __future__ import annotations

import threading

import pytest

from autograder.grade.parallel import map_parallel

MANY = tuple(range(50))


def test_results_have_the_order_of_the_items() -> None:
    second_done = threading.Event()

    def do(item: int) -> int:
        if item == 0:
            assert second_done.wait(60.0)
        return item * item

    def on_done(result: int) -> None:
        results.append(result)
        second_done.set()

    results: list[int] = []
    assert map_parallel(do, (0, 1, 2), jobs=2, on_done=on_done) == (0, 1, 4)
    assert sorted(results) == [0, 1, 4]
    assert results[0] != 0


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_no_item_is_started_after_an_error(error: type[BaseException]) -> None:
    begun: list[int] = []
    reported = threading.Event()

    def do(item: int) -> int:
        begun.append(item)
        assert item == 0 or reported.wait(60.0)
        return item

    def on_done(result: int) -> None:
        threading.Timer(0.2, reported.set).start()
        raise error("enough")

    with pytest.raises(error, match="enough"):
        map_parallel(do, MANY, jobs=2, on_done=on_done)
    assert 1 <= len(begun) <= 3


def test_an_exception_of_an_item_is_raised() -> None:
    begun: list[int] = []

    def do(item: int) -> int:
        begun.append(item)
        raise ValueError(f"item {item}")

    with pytest.raises(ValueError, match="item"):
        map_parallel(do, MANY, jobs=1, on_done=lambda result: None)
    assert begun[0] == 0
