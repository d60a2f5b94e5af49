"""Counter of Python calls: each function that was called while something ran, and how often."""

from __future__ import annotations

import gc
from collections import Counter
from collections.abc import Callable
from cProfile import Profile
from pathlib import Path
from types import CodeType

import arboleda

HERE = Path(__file__).parents[2]  # the folder of benchmarks
PRODUCT = Path(arboleda.__file__).parents[1]
Calls = Counter[str]
_counting: list[Profile] = []  # of the act that runs


def count(act: Callable[[], object]) -> Calls:
    """The calls of Python functions in this thread while `act` runs, by function; each resumption of a
    generator counts as one.

    Garbage is not collected meanwhile: finalizers would run at instants that nobody can foresee.
    """
    profile = Profile(subcalls=False, builtins=False)
    collects = gc.isenabled()
    gc.disable()
    _counting.append(profile)
    try:
        profile.runcall(act)
    finally:
        _counting.clear()
        if collects:
            gc.enable()
    calls: Calls = Counter()
    for entry in profile.getstats():
        if isinstance(entry.code, CodeType):
            calls[_name(entry.code)] += entry.callcount
    return calls


def stop_counting() -> None:
    """End the count of the act that runs: what it does from here on is free."""
    for profile in _counting:
        profile.disable()


def _name(code: CodeType) -> str:
    """`core/plant.py Plant.step`, without the folder in which a package or the library was installed."""
    file = Path(code.co_filename)
    for root in (PRODUCT, HERE):
        if file.is_relative_to(root):
            return f"{file.relative_to(root)} {_qualified(code)}"
    return f"{'/'.join(file.parts[-2:])} {_qualified(code)}"


def _qualified(code: CodeType) -> str:
    """The name of a function with its class, which Python 3.10 does not know."""
    return getattr(code, "co_qualname", code.co_name)
