"""The interface for a chapter's `attacks.py`: malicious submissions made from the reference, mutants and payloads."""

from autograder.author.verification.attack_writer import Chapter
from autograder.author.verification.payloads import (
    BLOCK_REPORT,
    FORGE_NAMED_REPORT,
    FORGE_PASSES,
    FORGE_REPORT,
    FORGE_VERDICTS,
    HOLD_KERNEL,
    SEARCH,
    STEAL_SECRETS,
    STOP_PARENT,
    TELL_ALL,
)
from autograder.author.verification.verdicts import Attack

__all__ = [
    "BLOCK_REPORT",
    "FORGE_NAMED_REPORT",
    "FORGE_PASSES",
    "FORGE_REPORT",
    "FORGE_VERDICTS",
    "HOLD_KERNEL",
    "SEARCH",
    "STEAL_SECRETS",
    "STOP_PARENT",
    "TELL_ALL",
    "Attack",
    "Chapter",
]
