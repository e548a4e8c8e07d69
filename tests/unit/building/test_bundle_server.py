"""A worker gets the error of interface packages that do not build, and does not repeat the build."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import Pipe
from pathlib import Path
from types import SimpleNamespace

import pytest

from autograder.building import bundle_server
from autograder.building.colcon import StoppedBuildError
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.messages import receive_message, send_message


@pytest.mark.parametrize("error", [StudentError, StoppedBuildError])
def test_a_build_that_a_limit_ended_is_not_tried_again_for_the_same_request(
    error: type[StudentError], tmp_path: Path
) -> None:
    ours, theirs = Pipe()
    with ours, theirs:
        send_message(theirs, bundle_server.failure_message(error(Diagnosis(Kind.BUILD_FAILED, "It was stopped."))))
        with pytest.raises(StudentError, match="It was stopped") as excinfo:
            bundle_server.request_build(ours, {}, tmp_path / "made")
    assert type(excinfo.value) is error


def test_submissions_that_wait_for_the_same_build_share_its_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Three requests bring the same sources at once, and a fourth later. The build lasts until all three have asked."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    requests, built = threading.Semaphore(0), list[str]()

    def now() -> float:
        requests.release()
        return time.time()

    def build(sources: object, isolation: object, entry: Path) -> None:
        for _ in range(3 if not built else 0):
            assert requests.acquire(timeout=30)
        built.append(entry.name)
        raise StoppedBuildError(Diagnosis(Kind.BUILD_FAILED, "It was stopped."))

    monkeypatch.setattr(bundle_server, "time", SimpleNamespace(time=now))
    monkeypatch.setattr(bundle_server, "_make", build)

    def ask(_: int) -> str:
        ours, theirs = Pipe()
        with ours, theirs:
            bundle_server._serve_build(ours, {}, Isolation.BUBBLEWRAP)
            with pytest.raises(StoppedBuildError, match="It was stopped") as excinfo:
                raise bundle_server._build_error(receive_message(theirs))
        return str(excinfo.value)

    with ThreadPoolExecutor(3) as threads:
        assert len(set(threads.map(ask, range(3)))) == 1
    assert len(built) == 1
    ask(4)
    assert len(built) == 2
