"""Kills and power cuts: an act is cut off before each change of a file, and somebody looks at what is there.

After a power cut a file that was not synced has its name and no content.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import Any
from unittest import mock

CHANGES = {"os.rename", "os.remove", "os.rmdir", "os.mkdir"}
WRITES = os.O_WRONLY | os.O_RDWR


class Cut(BaseException):
    """The process is dead: nothing catches this, and no file changes any more."""


@dataclass(frozen=True, kw_only=True)
class End:
    """End of an act: by a kill or a power cut after so many changes of files, or after all of them."""

    power: bool
    changes: int
    is_whole: bool


@dataclass
class Watch:
    """Watch of a process that dies after `left` changes of files."""

    left: int
    synced: set[int] = field(default_factory=set)

    def hear(self, event: str, told: tuple[Any, ...]) -> None:
        if event in CHANGES or (event == "open" and isinstance(told[2], int) and told[2] & WRITES):
            if self.left == 0:
                raise Cut
            self.left -= 1

    def sync(self, file: int) -> None:
        self.synced.add(os.fstat(file).st_ino)


_watching: list[Watch] = []  # one at most


def _hear(event: str, told: tuple[Any, ...]) -> None:
    for watch in _watching:
        watch.hear(event, told)


sys.addaudithook(_hear)  # for good: Python takes none back


def each_cut(folder: Path, act: Callable[[], object]) -> Iterator[End]:
    """Each way in which an act that changes files in `folder` can end; `folder` is as that left it."""
    before = folder.with_name(f"{folder.name}.before")
    shutil.copytree(folder, before)
    for left in count():
        for power in (False, True):
            shutil.rmtree(folder)
            shutil.copytree(before, folder)
            known = {each.stat().st_ino for each in folder.rglob("*")}
            watch = Watch(left)
            is_cut = _is_cut(watch, act)
            if power:
                _lose(folder, known | watch.synced)
            yield End(power=power, changes=left, is_whole=not is_cut)
        if not is_cut:
            return


def _is_cut(watch: Watch, act: Callable[[], object]) -> bool:
    with mock.patch.object(os, "fsync", watch.sync):
        _watching.append(watch)
        try:
            act()
        except Cut:
            return True
        finally:
            _watching.clear()
    return False


def _lose(folder: Path, kept: set[int]) -> None:
    for each in folder.rglob("*"):
        if each.is_file() and each.stat().st_ino not in kept:
            os.truncate(each, 0)
