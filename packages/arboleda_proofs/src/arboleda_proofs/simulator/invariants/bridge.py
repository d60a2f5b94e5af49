"""The bridge says what it heard, and sends what it was told."""

from __future__ import annotations

from collections.abc import Iterable

from ..recorded.motions import BEATS
from ..recorded.passed_commands import COMMANDS
from ..recorded.reported_telemetry import REPORTS
from .invariant import Look, Trigger, invariant


@invariant(Trigger.BRIDGED_WRONGLY)
def telemetry_is_reported(look: Look) -> Iterable[str]:
    """Whatever a board says while it is there is reported at once, as it is, and nothing else is."""
    return look.record.bridges.wrong[REPORTS]


@invariant(Trigger.BRIDGED_WRONGLY)
def commands_are_passed_on(look: Look) -> Iterable[str]:
    """The bridge sends a command on, under the next number, or refuses it with the word that is true."""
    return look.record.bridges.wrong[COMMANDS]


@invariant(Trigger.BRIDGED_WRONGLY)
def who_moves_hears_the_beat(look: Look) -> Iterable[str]:
    """A board whose motion has not ended gets the plant's beats, and one whose motion has ended gets none."""
    return look.record.bridges.wrong[BEATS]


BRIDGE = (telemetry_is_reported, commands_are_passed_on, who_moves_hears_the_beat)
