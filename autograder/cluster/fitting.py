"""Which of a scheduler's workers can grade for this machine: the others are refused, with a sentence each."""

from __future__ import annotations

import time
from collections.abc import Callable

from distributed import Client

from autograder.cluster.exceptions import ClusterError
from autograder.cluster.machine import difference

TICK = 0.5  # s between two looks
PATIENCE = 120.0  # s without any worker that fits


class FittingWorkers:
    """Looks at a scheduler's workers now and then.

    Args:
        client: the connection to the scheduler.
        resource: what workers offer who can grade this.
        say: is told once of each worker that is refused, and why.
    """

    def __init__(self, client: Client, resource: str, say: Callable[[str], None]) -> None:
        self._client, self._resource, self._say = client, resource, say
        self._refused: set[str] = set()
        self._threads = 0
        self._looked = float("-inf")
        self._fitted = time.monotonic()

    def threads(self) -> int:
        """Return how many submissions the workers that fit can grade at once.

        Raises:
            ClusterError: the scheduler does not answer, or there has been no such worker for two minutes.
        """
        now = time.monotonic()
        if now - self._looked >= TICK:
            self._look()
            self._looked = now
            if self._threads:
                self._fitted = now
            elif now - self._fitted > PATIENCE:
                raise ClusterError(
                    f"for {PATIENCE:.0f} s there was no worker that can grade this: start one with "
                    "`dask worker ADDRESS --preload autograder.cluster`"
                )
        return self._threads

    def _look(self) -> None:
        try:
            workers = self._client.scheduler_info()["workers"]
        except (OSError, RuntimeError, TimeoutError) as error:
            raise ClusterError(f"the scheduler does not answer: {error}") from None
        self._threads = 0
        for address, worker in workers.items():
            why = difference(self._resource, worker["resources"])
            if not why:
                self._threads += worker["nthreads"]
            elif address not in self._refused:
                self._refused.add(address)
                self._say(f"The worker {address} is refused: {why}.")
