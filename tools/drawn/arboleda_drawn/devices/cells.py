"""Cells of devices drawn from a seed: a layout, and the plant file that says it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from arboleda_proofs.simulator.chance import Dice

from .joined import groups_apart
from .kinds import Kind, draw_kind, shipped, value_of, with_spare
from .layout import Device, Layout, Need, Robot, Section
from .robots import RobotDrawer
from .steps import Value

ROLES = ("mill", "oven", "belt", "press", "lamp", "reader", "washer", "feeder")
PEOPLE = ("ana", "operator", "jose")
SHIPPED = ("camera", "sensor", "conveyor")
CELL = "cell"


class CellDrawer:
    """Draws a layout; `section` is the cell in its plant file, `kinds` and `zones` beside it."""

    def __init__(
        self, dice: Dice, spare: Dice, *, alike: bool, has_shared_hand: bool, are_written: bool
    ) -> None:
        self._dice = dice
        self._spare = spare  # for the verbs that only trials tell
        self._alike = alike  # a second cell will have the same roles
        self._has_shared_hand = has_shared_hand
        self._are_written = are_written  # the kinds, in Python
        self.kinds: dict[str, Kind] = {}
        self.zones: Section = {}
        self.section: Section = {}
        self.shared: Section = {}
        self._waits: frozenset[tuple[str, str]] = frozenset()

    def draw(self) -> Layout:
        dice = self._dice
        devices = self._devices()
        people = tuple(PEOPLE[: dice.pick((0, 0, 1, 1, 2))])
        robots = RobotDrawer(dice, devices, are_written=self._are_written)
        robots.draw(dice.pick((0, 0, 1, 1, 1, 2)), has_hand=self._has_shared_hand)
        devices = [*self._working(devices, robots), *robots.tools]
        needs = self._needs(devices)
        on_grid = {each.role for each in robots.robots if each.section["kind"] == "mobile"}
        found = [each if each.tool_of in on_grid else self._shared(each) for each in devices]
        hand = robots.parts.robot if self._has_shared_hand and robots.parts is not None else ""
        found = [
            replace(each, is_shared=True) if each.tool_of and each.tool_of == hand else each for each in found
        ]
        carriers = {each.tool_of for each in found if each.is_shared} | {hand}
        for robot in robots.robots:
            robots.replace(replace(robot, is_shared=robot.role in carriers))
        self._zones(found, robots, needs)
        layout = Layout(
            devices=tuple(found),
            robots=tuple(robots.robots),
            people=people,
            needs=needs,
            apart=(),
            parts=robots.parts,
            groups=robots.groups,
            shared_people=people if self._alike and dice.chance(0.4) else (),
            waits=self._waits,
        )
        self._say(layout, robots)
        return replace(layout, apart=groups_apart(layout))

    def _devices(self) -> list[Device]:
        dice = self._dice
        found: list[Device] = []
        count = dice.pick((1, 2, 2, 3, 3, 4))
        names = [f"kind_{number}" for number in range(1, 1 + min(count, dice.pick((1, 2, 3))))]
        drawn = [draw_kind(dice, name, is_written=self._are_written) for name in names]
        self.kinds = {kind.name: with_spare(self._spare, kind) for kind in drawn}
        for number in range(count):
            role = ROLES[(number * 3 + dice.below(3)) % len(ROLES)]
            if any(each.role == role for each in found):
                continue
            if number and dice.chance(0.2):
                name = dice.pick(SHIPPED)
                found.append(Device(role=role, kind=shipped(name), section={"kind": name}))
            else:
                found.append(self._device(role, self.kinds[dice.pick(names)]))
        used = {each.kind.name for each in found}
        self.kinds = {name: kind for name, kind in self.kinds.items() if name in used}
        return found

    def _device(self, role: str, kind: Kind) -> Device:
        dice = self._dice
        section: Section = {"kind": kind.name}
        if kind.is_written and dice.chance(0.4):
            section["pace"] = dice.pick((0.5, 0.9))
        evidence = "ids"
        if not kind.has_query and dice.chance(0.4):
            evidence = dice.pick(("facts", "joints", "state"))
            if evidence == "state" and any(verb.needs for verb in kind.verbs):
                evidence = "facts"
            if evidence in ("facts", "joints") and not all(verb.sets for verb in kind.verbs):
                evidence = "ids"
            section["evidence"] = evidence
        if dice.chance(0.3):
            section["mqtt"] = f"{role}_board"
        if dice.chance(0.1):
            section["stop"] = "none"
        return Device(role=role, kind=kind, evidence=evidence, section=section)

    def _working(self, devices: Sequence[Device], robots: RobotDrawer) -> list[Device]:
        """The devices; work of the one with the nest may need a part there, if no other is of its kind."""
        parts = robots.parts
        machine = next((each for each in devices if parts is not None and each.role == parts.machine), None)
        if machine is None or [each.kind.name for each in devices].count(machine.kind.name) > 1:
            return list(devices)
        works = [
            each for each in machine.kind.verbs if each.effect in ("process", "motion") and not each.sets
        ]
        if not works or not self._dice.chance(0.6):
            return list(devices)
        verb = self._dice.pick(works)
        verbs = tuple(replace(each, works_on=each is verb) for each in machine.kind.verbs)
        kind = self.kinds[machine.kind.name] = replace(machine.kind, verbs=verbs)
        return [replace(each, kind=kind) if each is machine else each for each in devices]

    def _needs(self, devices: Sequence[Device]) -> dict[tuple[str, str], tuple[Need, ...]]:
        """Needs of verbs on devices before their own."""
        dice = self._dice
        found: dict[tuple[str, str], tuple[Need, ...]] = {}
        for index, device in enumerate(devices):
            before = [each for each in devices[:index] if each.tells_facts and each.kind.is_settable]
            for verb in device.kind.verbs:
                if before and dice.chance(0.2):
                    other = dice.pick(before)
                    fact = dice.pick(other.kind.is_settable)
                    value = value_of(dice, other.kind.type_of(fact))
                    found[device.role, verb.name] = ((other.role, fact, value),)
        if found:
            self.section["needs"] = {
                f"{role}.{verb}": {f"{other}.{fact}": value for other, fact, value in needs}
                for (role, verb), needs in found.items()
            }
        return found

    def _shared(self, device: Device) -> Device:
        """The device, now and then one that both cells have; nobody else needs facts of it."""
        if not self._alike or not self._dice.chance(0.35):
            return device
        needed = any(
            f"{device.role}." in key for row in self.section.get("needs", {}).values() for key in row
        )
        return device if needed else replace(device, is_shared=True)

    def _zones(
        self, devices: Sequence[Device], robots: RobotDrawer, needs: dict[tuple[str, str], tuple[Need, ...]]
    ) -> None:
        dice = self._dice
        if dice.chance(0.5):
            self._door(devices, robots)
        if dice.chance(0.3) and len(devices) > 1:
            self._mouth(devices, needs)

    def _door(self, devices: Sequence[Device], robots: RobotDrawer) -> None:
        """A zone with the nest, or any target, and now and then the door of a machine."""
        dice = self._dice
        free = [each for each in robots.robots if not each.is_shared and not each.paths]
        if self._alike:
            free = [each for each in free if each.section["kind"] == "arm"]
        if not free:
            return
        robot = dice.pick(free)
        spots = [each for each in robot.targets if each != "home"]
        if robots.parts is not None and robots.parts.nest and robots.parts.robot == robot.role:
            spots = [robots.parts.nest]
        spot = dice.pick(spots)
        zone: Section = {"poses": [f"{CELL} {spot}"]}
        door: Need | None = None
        machines = [each for each in devices if self._has_door(each)]
        if machines and dice.chance(0.7):
            machine = dice.pick(machines)
            fact = dice.pick(machine.kind.is_settable)
            value = value_of(dice, machine.kind.type_of(fact))
            zone["free_while"] = {machine.role: {fact: value}}
            door = (machine.role, fact, value)
        robots.replace(replace(robot, doors={spot: door}))
        self.zones["inside"] = zone

    def _has_door(self, device: Device) -> bool:
        return (
            not device.is_shared
            and device.tells_facts
            and bool(device.kind.is_settable)
            and not device.tool_of
        )

    def _mouth(self, devices: Sequence[Device], needs: dict[tuple[str, str], tuple[Need, ...]]) -> None:
        """A zone of two devices without a pose: one waits until the other one is out of the way."""
        dice = self._dice
        for index, device in enumerate(devices[1:], 1):
            rams = [each for each in devices[:index] if self._has_door(each)]
            if rams and not device.is_shared and not device.tool_of and dice.chance(0.6):
                ram, verb = dice.pick(rams), dice.pick(device.kind.verbs)
                fact = dice.pick(ram.kind.is_settable)
                value: Value = value_of(dice, ram.kind.type_of(fact))
                known = needs.get((device.role, verb.name), ())
                if any((role, name) == (ram.role, fact) for role, name, _ in known):
                    return
                needs[device.role, verb.name] = (*known, (ram.role, fact, value))
                self._waits = frozenset({(device.role, verb.name)})
                self.zones["mouth"] = {
                    "free_while": {ram.role: {fact: value}},
                    "held_while": {device.role: [verb.name]},
                }
                return

    def _say(self, layout: Layout, robots: RobotDrawer) -> None:
        rows: Section = {}
        members: tuple[Robot | Device, ...] = (*robots.robots, *layout.devices)
        for each in members:
            if each.is_shared:
                self.shared[f"our_{each.role}"] = dict(each.section)
                rows[each.role] = {"shared": f"our_{each.role}"}
            else:
                rows[each.role] = each.section
        for name in layout.people:
            if name in layout.shared_people:
                self.shared[f"our_{name}"] = {"kind": "person"}
            rows[name] = {"shared": f"our_{name}"} if name in layout.shared_people else {"kind": "person"}
        for section in self.shared.values():
            if section.get("tool_of"):
                section["tool_of"] = f"our_{section['tool_of']}"
        needs = self.section.pop("needs", None)
        self.section = {"devices": rows, **robots.section}
        if needs:
            self.section["needs"] = needs
        dice = self._dice
        if dice.chance(0.3):
            self.section["queue_limit"] = dice.pick((1, 2, 5))
        if dice.chance(0.3):
            self.section["retry"] = {"times": dice.below(3), "backoff_s": dice.pick((0, 0.5))}
        if dice.chance(0.3):
            self.section["on_restart"] = "go_on"
        if self._alike:
            self.section["zone_wait_s"] = 3600  # a recipe of the other cell may take long
