"""An output of log lines that keeps what it gets, and a clock that stands still until it is moved."""

from __future__ import annotations

import logging

import pytest


class Shelf:
    """An output that keeps what it gets."""

    def __init__(self) -> None:
        self.lines: list[logging.LogRecord] = []

    def __call__(self, line: logging.LogRecord) -> None:
        self.lines.append(line)

    @property
    def texts(self) -> list[str]:
        return [line.getMessage() for line in self.lines]


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()
