"""Attacks on 09: sheets with every letter, and nodes that repeat old answers."""

from __future__ import annotations

from autograder.checking.attacks import FORGE_PASSES, STEAL_SECRETS, Attack, Chapter

CHAPTER = Chapter("09_assessment")
SHEET = "assessment/answers.yaml"
GUARD, THERMOMETER = (f"motor_guard/motor_guard/{name}.py" for name in ("guard", "thermometer"))
QUESTIONS = [f"q{number}" for number in range(1, 13)]


def attacks() -> tuple[Attack, ...]:
    """Return the attacks."""
    return (
        Attack(
            "every letter",
            "a sheet that gives each letter for each question",
            CHAPTER.write(files={SHEET: "".join(f"{name}: a, b, c, d\n" for name in QUESTIONS)}),
            frozenset(QUESTIONS),
            exactly=True,
            says="The answer to q1 is 'a, b, c, d', instead of one letter",
        ),
        Attack(
            "echo",
            "a guard that repeats its last decision, whatever it receives, and steals secrets",
            CHAPTER.write(
                heads={GUARD: STEAL_SECRETS + FORGE_PASSES},
                swaps={GUARD: ("            self.cooling = True\n", "            self.cooling = False\n")},
            ),
            frozenset({"hysteresis", "thresholds", "unknown"}),
        ),
        *CHAPTER.evasions(
            "fixed",
            "a thermometer with a fixed period",
            "period_is_fixed",
            THERMOMETER,
            ("self.create_timer(period,", "self.create_timer(period if _is_told() else 0.5,"),
        ),
    )
