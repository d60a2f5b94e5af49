"""Alternatives to late work at the end of a drawn recipe: a switch that the plant has to refuse, as what it
needs is not so.

They have dice of their own, so that the rest of a recipe does not depend on them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from arboleda_proofs.simulator.chance import Dice

from .kinds import Verb, another_value
from .layout import Device, Layout, Need
from .state import Planner, State
from .steps import Fallback, Step, Tell

OFTEN = 0.6  # how often a recipe ends so, where a device has what it takes
LONGEST_S = 12.0  # that the work takes


@dataclass(frozen=True, kw_only=True)
class Row:
    """Work of a device, and a switch of the device with one of its needs."""

    device: Device
    work: Verb
    switch: Verb
    need: Need


class LateWork:
    """Drawer of alternatives to late work, with devices that no other cell has."""

    def __init__(self, dice: Dice, layout: Layout) -> None:
        self._dice = dice
        self._layout = layout
        self._planner = Planner(layout, dice)
        rows = [row for each in layout.devices if self._is_ours(each.role) for row in self._of(each)]
        self._rows = [each for each in rows if each.need[0] == each.device.role] or rows

    def draw(self) -> list[Step]:
        """Work, and the switch where that is late; nothing where no device has these."""
        dice = self._dice
        if not self._rows or not dice.chance(OFTEN):
            return []
        row = dice.pick(self._rows)
        role, fact, needed = row.need
        other = another_value(dice, self._layout.device(role).kind.type_of(fact), needed)
        ready = [*self._layout.all_needs(row.device.role, row.work), (role, fact, other)]
        made = self._planner.establish(State(), ready)
        if made is None or not all(self._is_ours(each.role) for each in made[0]):
            return []
        work = Tell(role=row.device.role, verb=row.work.name, values=self._planner.values(row.work))
        values = self._planner.values(row.switch)
        switch = Tell(role=row.device.role, verb=row.switch.name, values=values, refused=True)
        return [*made[0], Fallback(steps=(work, switch))]

    def _of(self, device: Device) -> Iterator[Row]:
        works = [each for each in device.kind.verbs if _is_work(each)]
        for switch in device.kind.all_verbs:
            if switch.effect != "switch" or switch.holds or (device.role, switch.name) in self._layout.waits:
                continue
            for need in filter(self._can_be_unmet, self._layout.all_needs(device.role, switch)):
                yield from (
                    Row(device=device, work=each, switch=switch, need=need)
                    for each in works
                    if need[:2] not in [(device.role, fact) for fact, _ in each.sets]
                )

    def _is_ours(self, role: str) -> bool:
        device = self._layout.device(role)
        return not (device.is_shared or device.tool_of)

    def _can_be_unmet(self, need: Need) -> bool:
        device = self._layout.device(need[0])
        return self._is_ours(need[0]) and device.tells_facts and need[1] in device.kind.is_settable


def _is_work(verb: Verb) -> bool:
    is_motion = verb.effect in ("motion", "process")
    return is_motion and not (verb.holds or verb.works_on) and verb.takes_s <= LONGEST_S
