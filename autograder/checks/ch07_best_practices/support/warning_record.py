"""Records when a sensor processor warns while it receives scans, and applies the contract's rules."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field

from autograder.checking import LOCKSTEP, expect
from autograder.checks.ch07_best_practices.support.contract import MAX_SILENCE, WARN_PERIOD
from autograder.checks.ch07_best_practices.support.drawn_readings import Readings, mean_of
from autograder.checks.ch07_best_practices.support.robot import Processor, count_logged, scan_of

MAX_GAP = 0.5  # s between two scans without a distance that belong together: they come at least twice a second
STEP = 0.1  # s between two looks at the log
SLACK, REAL_SLACK = 0.15, 0.5  # s by which a time may differ, in lockstep and in real time


@dataclass
class WarningRecord:
    """The scans that a processor received, and its warnings, with times in seconds.

    What the processor logged before the record began is not part of it.

    Attributes:
        warnings: when the processor warned.
        blind: the times of the first and the last scan in each stretch of scans without a distance, among which there
            may be others.
    """

    processor: Processor
    warnings: list[float] = field(default_factory=list)
    blind: list[tuple[float, float]] = field(default_factory=list)
    _earlier_count: int = field(init=False)

    def __post_init__(self) -> None:
        self._earlier_count = count_logged(self.processor.output, "WARN")

    @property
    def slack(self) -> float:
        """By how many seconds a time may differ."""
        return SLACK if self.processor.time == LOCKSTEP else REAL_SLACK

    def send(self, cases: Sequence[Readings], *, gap: float, seconds: float) -> None:
        """Publish these scans in turn for some time, `gap` seconds apart."""
        for case in itertools.islice(itertools.cycle(cases), round(seconds / gap)):
            self.processor.publish("/scan", scan_of(case))
            self._run_and_record(min(gap, STEP))
            is_blind = mean_of(case.masked) is None
            if is_blind:
                now = self.processor.seconds
                is_next = bool(self.blind) and now - self.blind[-1][1] <= MAX_GAP + self.slack
                self.blind.append((self.blind.pop()[0] if is_next else now, now))
            for _ in range(round(gap / STEP) - 1):
                self._run_and_record(STEP)

    def expect_throttled(self) -> None:
        """Fail the check if the processor warned twice within 1 s."""
        for earlier, later in itertools.pairwise(self.warnings):
            expect(
                later - earlier >= WARN_PERIOD - self.slack,
                f"It warned about scans without a distance twice within {later - earlier:.1f} s.",
                fraction=0.5,
            )

    def expect_prompt(self) -> None:
        """Fail the check if, for more than 1.5 s, scans had no distance and the processor did not warn."""
        for start, end in self.blind:
            times = [start, *(time for time in self.warnings if start <= time <= end), end]
            silence = max(later - earlier for earlier, later in itertools.pairwise(times))
            message = f"For {silence:.1f} s, no scan had a distance, and it did not warn."
            expect(silence <= MAX_SILENCE + self.slack, message, fraction=0.5)

    def expect_none_after(self, end: float) -> None:
        """Fail the check if the processor warned more than 1 s after the last scan without a distance, at `end`."""
        late_warnings = [time for time in self.warnings if time > end + WARN_PERIOD + self.slack]
        message = "It warned for more than 1 s after the last scan without a distance."
        expect(not late_warnings, message, fraction=0.5)

    def _run_and_record(self, seconds: float) -> None:
        """Let the processor run, and record its warnings."""
        self.processor.run(seconds)
        count = count_logged(self.processor.output, "WARN") - self._earlier_count - len(self.warnings)
        self.warnings += [self.processor.seconds] * count
