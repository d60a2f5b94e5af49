"""Places of a cell and the numbers of parts there, which follow grips and outlive restarts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.effectors import HandlingStep
from arboleda.model.commands import Command, Motion, Position, Switch
from arboleda.model.grips import Grip
from arboleda.model.messages import Fact, Failure, Reason
from arboleda.model.plant_model import Cell, Evidence, Place, Workspace
from arboleda.model.sentence import Phrase, Sentence

from .asked_places import AskedPlaces
from .cell_devices import CellDevices
from .cell_robots import CellRobots

EMPTY = Phrase(
    "place.empty", "{robot}: no part is known to be at {place} (load {cell} {place} says that one is)"
)
FULL = Phrase(
    "place.full",
    "{robot}: {place} has {parts} already, and takes no more (unload {cell} {place} says that it is empty)",
)
HOLDS_ONE = Phrase("place.holds_one", "{robot} holds a part already, taken at {place}")
STILL_HELD = Phrase("place.still_held", "{robot} stays at {place}: {device} still holds the part there")
NO_PART = Phrase("place.no_part", "{robot} has no part to work on: none is known to be at {places}")
ASKED = Phrase("place.asked", "Is a part still in {place}? The last task failed, and may have left one there")


def trouble_in(sentence: Sentence) -> Sentence | None:
    """The part of a sentence that names a place without a part, or without room."""
    return next((each for each in sentence.parts() if each.key in (EMPTY.key, FULL.key)), None)


OPENED = frozenset({HandlingStep.TOLD_TO_TAKE, HandlingStep.EMPTY, HandlingStep.TAKEN_OUT})
SENSED_EMPTY = frozenset({HandlingStep.MISSED, HandlingStep.LOST})
OF_PLACE, OF_HAND, IN_QUESTION, KNOWN, SURE, LETTING_GO, LOST = "=", ":", "?", "~", "+", "-", "!"


@dataclass(frozen=True, kw_only=True)
class HeldPart:
    """Part that a hand may hold. `target` is where the hand took it; None where no part was known to be.

    `is_sure`: the hand has reported it. `lets_go`: the hand was told to let go, at `put_at` if that is known.
    """

    target: str | None = None
    is_sure: bool = False
    lets_go: bool = False
    put_at: str | None = None

    def back(self, here: str | None) -> str | None:
        """The target at which the part lies once the hand is empty; None where it is lost."""
        if self.lets_go and (self.is_sure or self.target):
            return here
        return self.missed_at

    @property
    def missed_at(self) -> str | None:
        """The target at which its hand has closed beside it, where its sensor has never seen it."""
        return None if self.is_sure else self.target

    @property
    def written(self) -> str:
        """The part as one word, for `read`."""
        letting_go = LETTING_GO + (self.put_at or "") if self.lets_go else ""
        return (self.target or "") + SURE * self.is_sure + letting_go

    @classmethod
    def read(cls, word: str) -> HeldPart:
        """The part that such a word stands for."""
        taken, lets_go, put_at = word.partition(LETTING_GO)
        return cls(
            target=taken.rstrip(SURE) or None,
            is_sure=SURE in taken,
            lets_go=bool(lets_go),
            put_at=put_at or None,
        )


class Places:
    """Books of the parts at the places of one cell.

    A part leaves its place when a hand is told to take it, and is at another once the hand has let go. A part
    that is lost on the way is nowhere until a person says where. A target that is no place gives and takes
    any number of parts. Stations of a rack are counted, and nothing is refused there.
    """

    def __init__(self, cell: Cell, dispatcher: Dispatcher, robots: CellRobots, devices: CellDevices) -> None:
        self._cell = cell
        self._dispatcher = dispatcher
        self._robots = robots
        self._devices = devices
        self._places = {place.target: place for place in cell.places}
        self._by_people = {each.target: each.holds * each.supply for each in cell.places if each.by_people}
        self._rack = frozenset(place.target for place in cell.rack)
        self._noted = {None, *self._rack}  # in a cell without places only parts from here are kept
        self._hands = {space.hand.name: space for space in cell.spaces if space.hand.held_fact}
        self._carts = _carts(cell)
        self._of_device: dict[str, list[str]] = {}
        for place in cell.places:
            if place.device is not None:
                self._of_device.setdefault(place.device, []).append(place.target)
        self._parts = {place.target: 0 for place in cell.counted}
        self._held: dict[str, HeldPart] = {}
        self.asked = AskedPlaces(self._places, self._parts, self._keep)
        self._made_at: dict[str, str | None] = {}  # by device, of the part that it was told to make last
        self._left_there: dict[
            str, str
        ] = {}  # by hand: the target whose part it was told to take, and did not
        self._lost: dict[str, HeldPart] = {}  # by closed hand: the part that it has not, by its sensor
        if self._parts:
            self._take_over(self._earlier_words())
            for device in {*self._hands, *self._of_device}:
                dispatcher.effectors.watchers[device].append(self._follow)

    def _earlier_words(self) -> list[str]:
        """The words of an earlier start; one of version 0.1 kept the numbers of full stations."""
        value, cell = self._dispatcher.memory.value, self._cell
        full = (value(Fact.STORED, cell.name) or "").split()
        stations = [name for number, name in enumerate(cell.station_targets) if str(number) in full]
        return [f"{name}{OF_PLACE}1" for name in stations] + (value(Fact.PARTS, cell.name) or "").split()

    def _take_over(self, books: list[str]) -> None:
        parts = _numbers(books, OF_PLACE)
        self._parts |= {target: n for target, n in parts.items() if target in self._parts}
        self.asked.take_over(dict(_read(books, IN_QUESTION)), _numbers(books, KNOWN))
        grips, words = self._dispatcher.effectors.grips, dict(_read(books, OF_HAND))
        lost = {hand: HeldPart.read(word[1:]) for hand, word in words.items() if word.startswith(LOST)}
        self._lost = {hand: lost[hand] for hand in self._hands if hand in lost and grips.holding(hand)}
        for hand in [each for each in self._hands if each not in lost]:
            taken = HeldPart(is_sure=True, lets_go=grips[hand] is Grip.SWITCHING)  # from no place
            held = HeldPart.read(words[hand]) if hand in words else taken
            # in a cell with places the books have each part in a hand, so a hand that they lack was empty
            is_empty = bool(self._places) and hand not in words and grips[hand] is Grip.SWITCHING
            if grips.holding(hand) and not is_empty:
                self._held[hand] = held
            elif hand in words:  # the plant ended before its command left
                self._move(held.back(None), +1, hand)

    def revise(self, cell: Cell) -> None:
        """Go by another version of the cell from now on, which has the same places."""
        self._cell = cell
        self._hands = {space.hand.name: space for space in cell.spaces if space.hand.held_fact}
        self._carts = _carts(cell)

    def parts(self, target: str) -> int:
        """The number of parts at a place."""
        return self._parts[target]

    def is_filled(self, target: str) -> bool:
        """True where a part is known to be at a place."""
        return self.parts(target) > 0

    def is_free(self, target: str) -> bool:
        """True where a place has room for another part."""
        return self.parts(target) < self._places[target].holds

    @property
    def counts(self) -> dict[str, int]:
        """The number of parts at each place."""
        return dict(self._parts)

    @property
    def full(self) -> frozenset[str]:
        """The places with a part."""
        return frozenset([target for target, parts in self._parts.items() if parts])

    @property
    def carriers(self) -> dict[str, bool]:
        """The robots that may have a part in the hand; True where the hand surely holds it."""
        grips = self._dispatcher.effectors.grips
        return {self._hands[hand].robot.name: grips[hand] is Grip.ON for hand in self._held}

    def is_so_still(self, trouble: Sentence) -> bool:
        """True while a trouble with a place lasts; people see to places of theirs without being told."""
        place = self._places[str(trouble.values["place"])]
        is_over = self.is_free if trouble.key == FULL.key else self.is_filled
        return not (place.by_people or is_over(place.target))

    def begin(self) -> None:
        """Begin a task: people have filled the supplies and emptied the outputs."""
        self._parts |= self._by_people
        self.asked.begin()
        if self._places:
            self._keep()

    def set(self, parts: Mapping[str, int]) -> None:
        """Take a person's word on how many parts are at places."""
        self._parts |= parts
        self.asked.answer(parts)
        self._keep()

    def objection(self, command: Command) -> Failure | None:
        """Objection to a command that would take a part where none is, or put one where no room is."""
        if isinstance(command, Switch) and command.grips is not None:
            sentence = self._to_grip(command.robot) if command.grips else self._to_let_go(command.robot)
        elif isinstance(command, Motion) and command.robot in self._cell.reach:
            sentence = _to_leave(command.robot, self.held_beside(command.robot))
        else:
            sentence = self._to_work(command)
        return None if sentence is None else Failure(reason=Reason.PRECONDITION, sentence=sentence)

    def _to_grip(self, hand: str) -> Sentence | None:
        space = self._hands.get(hand)
        if space is None:
            return self._without_part(hand)
        here = self._target(space)
        if self._dispatcher.effectors.grips[hand] is Grip.ON:
            taken = self._held.get(hand, HeldPart()).target
            return HOLDS_ONE(robot=hand, place=taken) if taken not in (None, here) else None
        if here not in self._places or self.is_filled(here):
            return None
        return EMPTY(robot=hand, place=here, cell=self._cell.name)

    def _to_let_go(self, hand: str) -> Sentence | None:
        space = self._hands.get(hand)
        here = self._target(space) if space is not None else None
        if here not in self._places or not self._dispatcher.effectors.grips.holding(hand):
            return None
        has_missed_it = hand in self._lost and self._lost[hand].missed_at == here
        if has_missed_it or self.is_free(here):
            return None
        return FULL(robot=hand, place=here, parts=self.parts(here), cell=self._cell.name)

    def held_beside(self, robot: str) -> Place | None:
        """The place whose device holds the same part as a robot's hand there; no robot leaves so."""
        space, grips = self._cell.reach[robot], self._dispatcher.effectors.grips
        place = self._places.get(self._target(space) or "")
        if place is None or place.device not in self._cell.holders or space.hand.held_fact is None:
            return None
        both = grips[place.device] is Grip.ON and grips[space.hand.name] is Grip.ON
        return place if both else None

    def _to_work(self, command: Command) -> Sentence | None:
        """The reason why a device has no part to work on, or no room for the part that it is to make."""
        device = command.robot
        if not command.makes_part:
            return self._without_part(device) if command.works_on_part else None
        full = [target for target in self._of_device.get(device, ()) if not self.is_free(target)]
        if not full or len(full) < len(self._of_device[device]):
            return None
        return FULL(robot=device, place=full[0], parts=self.parts(full[0]), cell=self._cell.name)

    def _without_part(self, device: str) -> Sentence | None:
        """The reason why a device has no part to take or to work on; parts in hands and carts there count."""
        targets = self._of_device.get(device)
        if not targets or any(map(self.parts, targets)):
            return None
        holding = [each for hand, each in self._hands.items() if hand in self._held]
        if any(self._target(space) in targets for space in (*holding, *self._carts)):
            return None
        return NO_PART(robot=device, places=tuple(targets))

    def _target(self, space: Workspace) -> str | None:
        """The target at which a robot stands, of several a place; None where that is unknown.

        A robot at `state`, which need not report a position, stands where its last move ended.
        """
        reached = self._dispatcher.whereabouts.reached.get(space.robot.name)
        here = self._robots.position(space.robot.name)
        if space.robot.evidence is Evidence.STATE and self._robots.as_planned is None:
            here = reached
        if here is None:
            return None
        targets = [target for target, pose in space.targets.items() if pose.q == reached]
        if not targets or (
            (self._places or not self._rack.isdisjoint(targets)) and not _stands(space, here, reached)
        ):
            targets = [target for target, pose in space.targets.items() if _stands(space, here, pose.q)]
        counted = [target for target in targets if target in self._parts]
        return next(iter(counted or targets), None)

    def _follow(self, hand: str, handling: HandlingStep) -> None:
        """Take in a step of a part's way through a hand, or in another device."""
        if hand not in self._hands:
            targets = self._of_device[hand]
            if handling is HandlingStep.TAKEN_OUT:
                self.set(dict.fromkeys(targets, 0))
            elif handling is HandlingStep.TOLD_TO_MAKE:
                self._made_at[hand] = next(filter(self.is_free, targets), None)
                self._move(self._made_at[hand], +1, hand)
                self._keep()
            elif handling is HandlingStep.NOT_MADE:
                self._move(self._made_at.pop(hand, None), -1, hand)
                self._keep()
            return
        held = self._held.get(hand) or HeldPart()
        here = held.target
        is_believed = self._cell.piece_check is not False and held.target not in self._rack
        if handling in SENSED_EMPTY and not (is_believed and hand in self._held):
            return  # nobody looks at the sensor here; of what is in a rack the recipes see to that
        if handling is HandlingStep.HELD and held.is_sure:
            return
        if handling in OPENED:
            self._lost.pop(hand, None)
        if handling is HandlingStep.MISSED:
            held, handling = replace(held, is_sure=False, lets_go=False), HandlingStep.EMPTY
            self._lost[hand] = held
        elif handling is HandlingStep.LOST:
            self._lost[hand] = held
        if handling in (HandlingStep.TOLD_TO_TAKE, HandlingStep.TOLD_TO_LET_GO):
            self._left_there.pop(hand, None)
        if handling is HandlingStep.TOLD_TO_TAKE:
            here = self._target(self._hands[hand])
            held = HeldPart(target=None if here in self._rack and not self._parts[here] else here)
            self._held[hand] = held
            self._move(here, -1, hand)
        elif handling is HandlingStep.HELD:
            late, lost = self._left_there.pop(hand, None), self._lost.pop(hand, None)
            if lost is not None:
                held = lost
                self._move(lost.missed_at, -1, hand)
            elif late is not None and self._target(self._hands[hand]) in (late, None):
                held = HeldPart(target=late)  # it takes the part after all
                self._move(late, -1, hand)
            self._held[hand] = replace(held, is_sure=True)
        elif handling is HandlingStep.TOLD_TO_LET_GO and hand in self._held:
            self._held[hand] = replace(held, lets_go=True, put_at=self._target(self._hands[hand]))
        elif handling in (HandlingStep.EMPTY, HandlingStep.TAKEN_OUT, HandlingStep.LOST):
            self._held.pop(hand, None)
            if handling is HandlingStep.EMPTY:
                here = self._put_down_at(hand, held) if held.lets_go else None
                back = held.back(here)
                self._move(back, +1, hand)
                if back is not None and not held.is_sure:
                    self.asked.doubt(back)
                    if hand not in self._lost:
                        self._left_there[hand] = back
        if self._places or not self._noted.isdisjoint((held.target, here)):
            self._keep()

    def _put_down_at(self, hand: str, held: HeldPart) -> str | None:
        """The target at which a hand has let go; where it was told to, if its robot is not heard."""
        space = self._hands[hand]
        tells_position = space.robot.evidence is not Evidence.STATE
        if tells_position and self._robots.position(space.robot.name) is None:
            return held.put_at
        return self._target(space)

    def _move(self, target: str | None, parts: int, hand: str) -> None:
        """Count a hand's parts at a target.

        Another cell's hand counts nothing at a place that people see to for each task of this cell.
        """
        if target in self._by_people and not self._is_ours(hand):
            return
        if target in self._rack:
            self._parts[target] = max(parts, 0)
        elif target in self._places:
            before = self._parts[target]
            self._parts[target] = max(before + parts, 0)
            if not self._is_ours(hand):
                self.asked.moved_by_others(target, self._parts[target] - before)
                self._dispatcher.wake([self._cell.name])  # a step of this cell may wait for it

    def _is_ours(self, hand: str) -> bool:
        """False while another cell has a hand that it shares with this one."""
        return not self._devices.is_lent(hand)

    def _keep(self) -> None:
        """Have the books kept: `nest=1` for a place, `jaw:nest+` for a hand and where it took its part,
        `nest?` for a place in question, `nest~1` for what was known to be there before its last task,
        `jaw:!nest+` for a closed hand that has lost its part; one without `+` never had it.

        In a cell with a rack and no places, a part from elsewhere is not kept: the grip of its hand says
        enough.
        """
        words = [f"{target}{OF_PLACE}{number}" for target, number in sorted(self._parts.items()) if number]
        held, lost = (
            sorted([each for each in hands.items() if self._places or each[1].target in self._noted])
            for hands in (self._held, self._lost)
        )
        words += [f"{hand}{OF_HAND}{part.written}" for hand, part in held]
        words += [f"{hand}{OF_HAND}{LOST}{part.written}" for hand, part in lost]
        words += [f"{target}{IN_QUESTION}" for target in self.asked.targets]
        words += [f"{target}{KNOWN}{number}" for target, number in sorted(self.asked.known.items())]
        self._dispatcher.memory.remember(Fact.STORED, self._cell.name, None)
        self._dispatcher.memory.remember(Fact.PARTS, self._cell.name, " ".join(words) or None)


def _to_leave(robot: str, place: Place | None) -> Sentence | None:
    """The reason why a robot must not leave with its part: a device holds the same part."""
    if place is None or place.device is None:
        return None
    return STILL_HELD(robot=robot, place=place.target, device=place.device)


def _carts(cell: Cell) -> list[Workspace]:
    """Mobile robots without a hand: nobody counts the parts that they bring to a place."""
    driven = (space for space in cell.spaces if space.robot.position_key == "node")
    return [space for space in driven if not space.hand.held_fact]


def _stands(space: Workspace, here: Position, at: Position | None) -> bool:
    return at is not None and space.robot.motion.stands_at(here, at)


def _read(words: Iterable[str], mark: str) -> list[tuple[str, str]]:
    """The words with this mark, as pairs of the names before it and the values after it."""
    parts = (word.partition(mark) for word in words)
    return [(name, value) for name, separator, value in parts if separator]


def _numbers(words: Iterable[str], mark: str) -> dict[str, int]:
    return {name: int(number) for name, number in _read(words, mark) if number.isdigit()}
