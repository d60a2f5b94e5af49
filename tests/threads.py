"""Threads that are none: their work is done in the thread of the test, at a moment that the test knows."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Sequence
from functools import partial
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest


class AtOnce:
    """A thread whose work is done before `start` comes back."""

    def __init__(
        self,
        target: Callable[..., object],
        name: str = "",
        args: Sequence[object] = (),
        *,
        daemon: bool = False,
    ) -> None:
        self.name = name
        self.ident: int | None = None
        self._work = partial(target, *args)

    def start(self) -> None:
        self.ident = 1
        self._work()

    def join(self, timeout: float | None = None) -> None: ...

    def is_alive(self) -> bool:
        return False


class AtTheEnd(AtOnce):
    """A thread whose work is done once somebody waits for its end."""

    _is_due = False

    def start(self) -> None:
        self.ident = 1
        self._is_due = True

    def join(self, timeout: float | None = None) -> None:
        if self._is_due:
            self._is_due = False
            self._work()


async def run_here(function: Callable[..., Any], *arguments: Any, **_: Any) -> Any:
    """What a thread of a pool would do; others have their turn before, as they would there."""
    await asyncio.sleep(0)
    return function(*arguments)


def stand_in(module: ModuleType, kind: type[AtOnce], patch: pytest.MonkeyPatch) -> None:
    """Give the module such threads; locks and events stay as they are."""
    patch.setattr(module, "threading", SimpleNamespace(**{**vars(threading), "Thread": kind}))
