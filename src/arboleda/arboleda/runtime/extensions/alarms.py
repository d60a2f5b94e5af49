"""Alarms of packages: any thread raises and ends them; people see those that stand."""

from __future__ import annotations

import logging
import threading
from dataclasses import replace
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
        part: str = "",
    ) -> RaisedAlarm:
        """Raise an alarm; the same one that stands already is not raised again. ValueError for an empty
        sentence, and for a level that there is not.

        Of more than MOST alarms of a package the oldest one ends.
        """
        said = OWN(text=in_one_line(sentence)) if isinstance(sentence, str) else sentence
        if not str(said):
            raise ValueError("an alarm needs a sentence: what happened, and what people are to do")
        wanted = PackageAlarm(
            id=next(self._numbers),
            package=package,
            sentence=said,
            cell=cell,
            level=AlarmLevel(level),
            part=part,
        )
        with self._changing:
            raised = next((each for each in self.standing if _is_same(each, wanted)), None)
            if raised is None:
                raised = wanted
                self._raise(wanted)
        return RaisedAlarm(self, raised)

    def end(self, *ended: PackageAlarm) -> None:
        """End these alarms."""
        with self._changing:
            self._drop(*ended)

    def end_all(self, part: str) -> None:
        """End all alarms of a part of a package."""
        self.end(*(each for each in self.standing if each.part == part))

    def rows(self) -> dict[str, Any]:
        """The alarms that stand as a snapshot has them."""
        return {"alarms": [each.row() for each in self.standing]}

    def diagnosis(self) -> diagnostics.Diagnostic:
        """The alarms as a diagnosis for /diagnostics."""
        return diagnostics.packages(self.standing)

    def _raise(self, raised: PackageAlarm) -> None:
        mine = [each for each in self.standing if each.package == raised.package]
        self._drop(*mine[: 1 - MOST])
        self.standing = (*self.standing, raised)
        LOG.warning("%s", raised.said, extra={"sentence": raised.said})

    def _drop(self, *ended: PackageAlarm) -> None:
        for each in ended:
            if each in self.standing:
                over = OVER(said=each.said)
                LOG.info("%s", over, extra={"sentence": over})
        self.standing = tuple(each for each in self.standing if each not in ended)


def _is_same(alarm: PackageAlarm, other: PackageAlarm) -> bool:
    return replace(alarm, id=other.id) == other
