"""Lengths of tests that sample: short by day; whole in `make nightly`, by ARBOLEDA_LENGTH=whole."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TypeVar

S, T = TypeVar("S"), TypeVar("T")

WHOLE = os.environ.get("ARBOLEDA_LENGTH") == "whole"


def sample(cases: Iterable[T], every: int) -> list[T]:
    """Each so manieth of the cases, always the same ones; all of them where tests are whole."""
    found = list(cases)
    return found if WHOLE else found[::every]


def length(short: S, whole: T) -> S | T:
    """The one that is asked for."""
    return whole if WHOLE else short
