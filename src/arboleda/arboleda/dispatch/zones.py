"""Shared zones: which robot holds which zone, and which robots wait; first come, first served.

A device that cells share counts as a zone too. Its holder is the cell whose task uses it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from arboleda.model.errors import IllegalTransition
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase

from .zone_queue import ZoneQueue

STILL_IN = Phrase(
    "zone.still_in",
    "{robot} may still be in {zones}, which is quarantined: "
    "it gets none before it is back, homed and seen outside",
)
NO_MORE = Phrase(
    "zone.no_more",
    "{robot} holds {held} and asks for {asked}: nobody standing in a zone waits for another",
)
WAITS = Phrase("zone.waits", "{robot} waits for {waits} and asks for {asked}: withdraw first")
TAKEN = Phrase("zone.taken", "zone {zone} is held by {holder}, not free for {robot}")
NOT_QUARANTINED = Phrase(
    "zone.not_quarantined", "zone {zone} is {now}; only a quarantined zone can be overridden"
)
HELD_BY = Phrase("zone.held_by", "held by {robot}, which still reports")
FREE = Phrase("zone.free", "free")
NO_ZONE = Phrase("zone.unknown", 'there is no zone "{zone}"; zones of this plant: {known}')
NONE = Phrase("none", "none")


class Zones:
    """At most one robot per zone.

    A robot takes all the zones of its way at once, from outside. So no robot that holds a zone waits for
    another zone, and there is no deadlock. A quarantined zone may still have its silent robot in it, so it is
    given to no other robot. `names` is in the order of the plant file.
    """

    def __init__(self, names: Iterable[str], quarantined: Mapping[str, str] | None = None) -> None:
        """`quarantined`: zone -> robot, of an earlier start; zones that are not in `names` are left out."""
        self.names = tuple(names)
        self._holders = {zone: robot for zone, robot in (quarantined or {}).items() if zone in self.names}
        self._quarantined = set(self._holders)
        self._robbed = set(self._holders.values())  # robots inside that may have had more than they hold
        self.queue = ZoneQueue()

    def holder(self, zone: str) -> str | None:
        """The robot that is in a zone; of a quarantined zone the robot that may be in it."""
        return self._holders.get(zone)

    def held_by(self, robot: str) -> frozenset[str]:
        """The zones that a robot holds, with quarantined zones."""
        return frozenset([zone for zone, holder in self._holders.items() if holder == robot])

    @property
    def is_used(self) -> bool:
        """True while anybody holds a zone."""
        return bool(self._holders)

    @property
    def holders(self) -> Mapping[str, str]:
        """The robot in each zone that has one."""
        return self._holders

    @property
    def robots(self) -> set[str]:
        """All holders of zones."""
        return set(self._holders.values())

    @property
    def robbed(self) -> set[str]:
        """Robots in zones that an override has taken from them; each of them may try to `regain` these."""
        return set(self._robbed)

    def awaited(self, robot: str, zones: Iterable[str]) -> dict[str, str]:
        """The zones of these that another robot holds, in order of their names, each with its holder."""
        holders = [(zone, self._holders.get(zone)) for zone in sorted(zones)]
        return {zone: other for zone, other in holders if other is not None and other != robot}

    def is_quarantined(self, zone: str) -> bool:
        return zone in self._quarantined

    def acquire(self, robot: str, zones: frozenset[str], *, moves_over: bool = False) -> bool:
        """Acquire all of `zones`: True where the robot holds them now, else it waits; it may ask again.

        IllegalTransition for an unknown zone, for more than the robot holds, for other zones than it waits
        for, and while one of its zones is quarantined. `moves_over`: a machine in the way of one zone may ask
        for another zone, to get there. It goes first, as others may wait for the zone that it leaves.
        """
        for zone in sorted(zones):
            self._require_known(zone)
        held = self.held_by(robot)
        if held & self._quarantined:
            raise IllegalTransition(STILL_IN(robot=robot, zones=_named(held)))
        if zones <= held:
            return True
        if held and not moves_over:
            raise IllegalTransition(NO_MORE(robot=robot, held=_named(held), asked=_named(zones)))
        if (asked := self.queue.asked_by(robot)) not in (None, zones):
            raise IllegalTransition(WAITS(robot=robot, waits=_named(asked or zones), asked=_named(zones)))
        self.queue.join(robot, zones)
        if held:
            self.queue.go_first(robot)
        return robot in self._grant()

    def claim(self, robot: str, zones: frozenset[str]) -> None:
        """Take zones for a robot that may be in them; IllegalTransition where another robot holds one."""
        for zone in sorted(zones):
            if self.holder(zone) not in (None, robot):
                raise IllegalTransition(TAKEN(zone=zone, holder=self.holder(zone) or "", robot=robot))
        self._holders.update(dict.fromkeys(zones, robot))
        self._robbed.discard(robot)
        if (self.queue.asked_by(robot) or zones) <= self.held_by(robot):
            self.queue.leave(robot)

    def regain(self, robot: str, zones: frozenset[str]) -> bool:
        """True where a robot in a zone has all that it needs to get out, `zones` at most; it never waits.

        It takes again the zones that an override took from it, where no other robot holds one of them.
        """
        if robot in self._robbed and all(self.holder(zone) in (None, robot) for zone in zones):
            self.claim(robot, zones)
        return robot not in self._robbed

    def withdraw(self, robot: str) -> tuple[str, ...]:
        """Have a robot wait no more; returns the robots that get their zones by this, the first first."""
        self.queue.leave(robot)
        return self._grant()

    def release(self, robot: str) -> tuple[str, ...]:
        """Free the zones of a robot that is seen outside, but for quarantined ones. Returns as `withdraw`."""
        return self._free(self.held_by(robot) - self._quarantined)

    def quarantine(self, robot: str) -> None:
        """Quarantine the zones of a robot that fell silent, until `restore` or `override`."""
        self._quarantined |= self.held_by(robot)

    def restore(self, robot: str) -> tuple[str, ...]:
        """Free the quarantined zones of a robot that is back, homed and outside. Returns as `withdraw`."""
        return self._free(self.held_by(robot) & self._quarantined)

    def lift_quarantine(self, machine: str) -> None:
        """End the quarantine of a machine's zones: it is heard, and reports which ones it occupies."""
        self._quarantined -= self.held_by(machine)

    def quarantine_device(self, device: str) -> None:
        """Quarantine a shared device that fell silent: its cell holds it until `give_back` or `override`."""
        if device in self._holders:
            self._quarantined.add(device)

    def give_back(self, names: frozenset[str]) -> tuple[str, ...]:
        """Free shared devices that do nothing, or zones that their holder has left. Returns as `withdraw`."""
        return self._free(names & self._holders.keys())

    def override(self, zone: str) -> tuple[str, ...]:
        """Free one quarantined zone, as an operator answers that it is empty. Returns as `withdraw`.

        IllegalTransition for a zone that is not quarantined.
        """
        self.require_quarantined(zone)
        self._robbed.add(self._holders[zone])
        return self._free(frozenset({zone}))

    def require_quarantined(self, zone: str) -> None:
        """Raise IllegalTransition for a zone that is not quarantined."""
        self._require_known(zone)
        if zone not in self._quarantined:
            holder = self.holder(zone)
            now = HELD_BY(robot=holder) if holder else FREE()
            raise IllegalTransition(NOT_QUARANTINED(zone=zone, now=now))

    def _free(self, zones: frozenset[str]) -> tuple[str, ...]:
        self._quarantined -= zones
        for zone in zones:
            del self._holders[zone]
        self._robbed &= self.robots
        return self._grant()

    def _grant(self) -> tuple[str, ...]:
        """Give zones to the waiting in order; none gets past an earlier robot that asked for one of them."""
        granted = []
        taken = set(self._holders)
        for robot, zones in self.queue.waiting:
            if (zones - self.held_by(robot)).isdisjoint(taken):
                self.queue.leave(robot)
                self._holders.update(dict.fromkeys(zones, robot))
                granted.append(robot)
            taken |= zones
        return tuple(granted)

    def _require_known(self, zone: str) -> None:
        if zone not in self.names:
            names = self.names or NONE()
            raise IllegalTransition(NO_ZONE(zone=plain(zone, 40), known=names))


def _named(zones: frozenset[str]) -> tuple[str, ...]:
    return tuple(sorted(zones))
