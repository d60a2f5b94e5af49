"""Parts of one process in the order in which they start; they end in the opposite one."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

from arboleda.model.errors import StartError
from arboleda.model.outside import plain
from arboleda.plant_file.python_uses import error_text

from .parts.part import Part
from .registry import Assembly, Factory, packaged

LOG = logging.getLogger(__name__)
LONGEST = 300  # characters of an error of a package
LEFT_OUT = "the package {package} is left out of this plant: {why}"


class _Made(NamedTuple):
    part: Part
    package: str  # that is left out where the part breaks; "" for one that the plant needs


class PartList:
    """PartList: makes, starts and ends parts.

    A part of the runner that cannot start keeps the plant from starting, and so does a part of a package that
    the plant needs. Another package may be for a count or a card on the page: where it breaks, robots work
    without it, and `notes` say so. A StartError is raised, whoever raises it.
    """

    def __init__(self) -> None:
        self.notes: list[str] = []
        self._made: list[_Made] = []
        self._started: list[_Made] = []
        self._left_out: set[str] = set()

    def __iter__(self) -> Iterator[Part]:
        return (each.part for each in self._made)

    def make(self, assembly: Assembly, own: Iterable[Factory]) -> None:
        """Make all parts, of the runner's `own` factories and of packages, in the order of their phases."""
        factories = [*(("", each) for each in own), *packaged(self.leave_out)]
        for package, factory in sorted(factories, key=lambda each: each[1].phase):
            if package not in self._left_out:
                spared = "" if factory.is_needed else package
                with self._sparing(spared):
                    self._made += [_Made(part, spared) for part in factory.make(assembly)]

    def start(self) -> None:
        """Start every part in order."""
        for each in self._made:
            self._started.append(each)
            with self._sparing(each.package):
                each.part.start()

    def stop(self) -> None:
        """End the parts that were started in the opposite order; idempotent."""
        while self._started:
            part, package = self._started.pop()
            with self._sparing(package):
                part.stop()

    def leave_out(self, package: str, error: BaseException) -> None:
        """Note once that a package breaks, and make no other part of it."""
        LOG.debug("the package %s broke", package, exc_info=error)
        if package in self._left_out:
            return
        self._left_out.add(package)
        self.notes.append(LEFT_OUT.format(package=plain(package), why=plain(error_text(error), LONGEST)))
        LOG.warning("%s", self.notes[-1])

    @contextmanager
    def _sparing(self, package: str) -> Iterator[None]:
        """Leave a package out that breaks, and go on; an error of the runner itself is raised."""
        try:
            yield
        except StartError:
            raise
        except Exception as error:
            if not package:
                raise
            self.leave_out(package, error)
