"""Work under way at the other ends of a device, and its failures in words."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from arboleda.drivers import DriverError, OnStop, VerbCommand, Work, plain
from arboleda_drivers.paths import field_at
from arboleda_drivers.ros_action.events import Status
from arboleda_drivers.ros_action.goal import Goal
from arboleda_drivers.ros_action.homing import LONGEST_WORD

from .heard_facts import TEXT
from .keys import Call, Field, Verb

SPARE_S = 0.5  # the plant's own deadline comes first


@dataclass(kw_only=True)
class Job(Goal):
    """Goal or request of a command that has not ended yet."""

    command: VerbCommand
    verb: Verb
    uuid: bytes = b""

    @property
    def is_work(self) -> bool:
        return isinstance(self.command, Work)

    @property
    def is_over(self) -> bool:
        """True where it has ended well, and its facts are waited for."""
        return self.succeeded_at is not None

    @property
    def finishes(self) -> bool:
        """True for a work that goes on to its own end when it is stopped."""
        command = self.command
        goes_on = not self.stopped and not self.is_over
        return goes_on and isinstance(command, Work) and command.on_stop is OnStop.FINISH


def job(now: float, command: VerbCommand, verb: Verb) -> Job:
    over_at = math.inf if command.at_most_s is None else now + command.at_most_s + SPARE_S
    return Job(id=command.id, parts=(None,), sent_at=now, over_at=over_at, command=command, verb=verb)


def failure(call: Call, status: Status, message: object) -> str:
    """The word for an end without success; "" for a success, by its status and its fields."""
    wrong = [f"{path} is {told}" for path, told in _unlike(call.done, message)]
    if status is Status.SUCCEEDED and not wrong:
        return ""
    if status is Status.CANCELED:
        return "cancelled_by_another_client"
    said = "" if call.failure is None or message is None else word(call.failure, message)
    return plain(said or ", ".join(wrong) or "aborted", LONGEST_WORD)


def word(field: Field, message: object) -> str:
    """The word for a field: that of the mapping, else its value."""
    raw = field_at(field.field, message)
    try:
        return str(field.value(raw, TEXT, field.field))
    except DriverError:
        return str(raw) if isinstance(raw, str) else f"{field.field} {raw}"


def _unlike(done: Mapping[str, object], message: object) -> list[tuple[str, object]]:
    if message is None:
        return []
    told = ((path, value, field_at(path, message)) for path, value in done.items())
    return [(path, found) for path, value, found in told if found != value]
