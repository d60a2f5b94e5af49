"""Failures as the memory of a task keeps them."""

from __future__ import annotations

from typing import Any

from .messages import Failure, Reason
from .sentence import retold


def failure_kept(failure: Failure) -> Any:
    """A failure as it is kept."""
    return [failure.reason.value, str(failure.sentence), failure.sentence.data()]


def read_failure(reason: str, english: str, data: Any) -> Failure:
    """A failure as it was kept."""
    return Failure(reason=Reason(reason), sentence=retold(english, data))
