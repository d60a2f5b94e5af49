"""Alarms of packages: any thread raises and ends them; people see those that stand."""

from __future__ import annotations

import logging
import threading
from itertools import count
from typing import Any

from arboleda.model.outside import plain
from arboleda.model.sentence import OWN, Sentence
from arboleda.views import diagnostics
from arboleda.views.alarms import LONGEST, OVER, AlarmLevel, PackageAlarm

LOG = logging.getLogger(__name__)
MOST = 20  # alarms of one package that stand; a package that raises more of them has forgotten to end some


def in_one_line(text: str) -> str:
    """A text of a package as people read it."""
    return plain(" ".join(text.split()), LONGEST)


class RaisedAlarm:
    """Alarm that a package has raised."""

    def __init__(self, alarms: PackageAlarms, raised: PackageAlarm) -> None:
        self._alarms = alarms
        self._raised = raised

    def end(self) -> None:
        """Tell people that it is over; from any thread, idempotent."""
        self._alarms.end(self._raised)


class PackageAlarms:
    """PackageAlarms: those of all packages that stand; every call returns at once, in any thread."""

    def __init__(self) -> None:
        self.standing: tuple[PackageAlarm, ...] = ()  # another tuple after each change
        self._numbers = count(1)
        self._changing = threading.Lock()

    def add(
        self,
        package: str,
        sentence: str | Sentence,
        *,
        cell: str = "",
        level: AlarmLevel | str = AlarmLevel.WARNING,
    ) -> RaisedAlarm:
        """Raise an alarm; the same one that stands already is not raised again. ValueError for an empty
        sentence, and for a level that there is not.

        Of more than MOST alarms of a package the oldest one ends.
        """
        said = OWN(text=in_one_line(sentence)) if isinstance(sentence, str) else sentence
        if not str(said):
            raise ValueError("an alarm needs a sentence: what happened, and what people are to do")
        with self._changing:
            found = self._equal(package, said, cell, AlarmLevel(level))
            raised = found or self._raised(package, said, cell, AlarmLevel(level))
        return RaisedAlarm(self, raised)

    def end(self, *ended: PackageAlarm) -> None:
        """End these alarms."""
        with self._changing:
            self._drop(*ended)

    def end_all(self, package: str) -> None:
        """End all alarms of a package."""
        self.end(*self._of(package))

    def rows(self) -> dict[str, Any]:
        """The alarms that stand as a snapshot has them."""
        return {"alarms": [each.row() for each in self.standing]}

    def diagnosis(self) -> diagnostics.Diagnostic:
        """The alarms as a diagnosis for /diagnostics."""
        return diagnostics.packages(self.standing)

    def _equal(self, package: str, sentence: Sentence, cell: str, level: AlarmLevel) -> PackageAlarm | None:
        there = (each for each in self._of(package) if (each.cell, each.level) == (cell, level))
        return next((each for each in there if each.sentence == sentence), None)

    def _raised(self, package: str, sentence: Sentence, cell: str, level: AlarmLevel) -> PackageAlarm:
        raised = PackageAlarm(
            id=next(self._numbers), package=package, sentence=sentence, cell=cell, level=level
        )
        self._drop(*self._of(package)[: 1 - MOST])
        self.standing = (*self.standing, raised)
        LOG.warning("%s", raised.said, extra={"sentence": raised.said})
        return raised

    def _of(self, package: str) -> list[PackageAlarm]:
        return [each for each in self.standing if each.package == package]

    def _drop(self, *ended: PackageAlarm) -> None:
        for each in ended:
            if each in self.standing:
                over = OVER(said=each.said)
                LOG.info("%s", over, extra={"sentence": over})
        self.standing = tuple(each for each in self.standing if each not in ended)
