"""Truth about the places of cells: where parts are by what hands have truly done."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from arboleda.drivers import Command, Evidence, Position, Robot, Switch, makes_parts
from arboleda.engine import Entry, State
from arboleda.engine.inspection import EMPTY, Grip, effectors_of, grips_of, places_of, trouble_in
from arboleda.model import text
from arboleda.model.common_places import with_common_places
from arboleda.model.messages import OperatorAnswer, OperatorRequest, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Cell, Place, Workspace
from arboleda.recipes import Recipe
from arboleda.rig.world import World

from ..recorded.scopes import Scopes
from .grips import Effector, part_poses
from .mobile import MobileTruth
from .robot import RobotTruth


class CellPlaces:
    """True number of parts at each place of one cell. A station of a rack has one or none, and gets one of
    each task; what lay there before is taken out by people.

    `at_begin` and `at_end` have those when its last task that is done began and ended; what another cell
    meanwhile did with a hand that both share counts as if it was before. `as_left` has those of the places at
    which that task put or took a part last, and of those where no other cell did; of a rack only what that
    task put there. What people meanwhile brought or took out does not count there. `is_doubtful` once nobody
    could know them any more, `end_is_doubtful` where that was so when that task ended: a device has lied or
    lost its power, its effector was stuck and nobody reports that, somebody took a hand's part, a hand took
    one at a station where none was known, closed where its robot stood at no target, closed or opened after
    its robot had set out for elsewhere, or a place and another target are one to its robot. The next task
    begins with what is in the books then, unless a hand still holds something. `late_hands` were in the
    middle of a grip, on an earlier command, as that task began.
    """

    def __init__(self, cell: Cell, robots: Mapping[str, Any]) -> None:
        self.cell = cell
        self.parts = {place.target: 0 for place in cell.counted}
        self.at_begin = self.at_end = self.as_left = dict(self.parts)
        self._left: dict[str, int] = {}  # by this task, since it began
        self._put: set[str] = set()  # the stations at which it has put a part, over all starts
        self._touched: set[str] = set()  # the places that it may have left full, over all starts
        self._moved_by_others: set[str] = set()
        self._brought: Counter[str] = Counter()  # by people since it began, less what they took out
        self._began_with = dict(self.parts)
        self.late_hands: frozenset[str] = frozenset()
        self._began_in_grip: frozenset[str] = frozenset()
        self.is_doubtful = self.end_is_doubtful = False
        self.by_people = {place.target for place in cell.counted if place.by_people}
        self._places = {place.target: place for place in cell.counted}
        self.makes_parts = any(map(makes_parts, cell.robots))
        self._rack = frozenset(place.target for place in cell.rack)
        self._hands = {space.hand.name: space for space in cell.spaces if space.hand.held_fact}
        self._task = ""
        self.has_failed = False  # its last task, which is not done
        self._giver: Robot | None = None  # that brings what its task takes
        self.came: set[Position] = set()  # where the giver has stood since that task began
        self._held = {hand: _holds(robots[hand]) for hand in self._hands if hand in robots}
        # effectors that have closed beside the part, by the places there, or have lost it
        self.empty_handed: dict[str, list[str] | None] = {}

    def begin(self, task: str, recipe: Recipe, booked: Mapping[str, int], in_grip: Iterable[str]) -> None:
        """A task begins: people have filled the supplies and emptied the outputs, but for one that a failed
        task has left full; these hands are about to close or to open.

        What a task has put at stations counts also if it begins anew in a later start.
        """
        handover = self.cell.handover
        is_brought = handover is not None and recipe.alone is None
        self._giver = self.cell.reach[handover.giver].robot if handover is not None and is_brought else None
        if task != self._task:
            self._task, self._put, self._touched, self.came = task, set(), set(), set()
        self._began_in_grip = frozenset(in_grip)
        if self.is_doubtful:
            self.parts = dict(booked)
            # a hand has what the plant may not know of, or is about to take what is booked as taken
            self.is_doubtful = any(self._held.values()) or bool(self._began_in_grip)
        left = {each for each, n in self.parts.items() if self.has_failed and n >= self._places[each].holds}
        for place in map(self._places.__getitem__, self.by_people):
            if place.supply or place.target not in left:
                self.parts[place.target] = place.holds if place.supply else 0
        self.has_failed = True  # as long as it is not done
        self._began_with = dict(self.parts)
        self._left, self._moved_by_others, self._brought = {}, set(), Counter()

    def end(self) -> None:
        """The task is done."""
        self.has_failed = False
        self.at_begin, self.at_end = self._began_with, dict(self.parts)
        unseen = self._moved_by_others - self._left.keys()
        left = self._without_people | self._left | {each: int(each in self._put) for each in self._rack}
        self.as_left = {each: n for each, n in left.items() if each not in unseen}
        self.end_is_doubtful, self.late_hands = self.is_doubtful, self._began_in_grip

    @property
    def _without_people(self) -> dict[str, int]:
        return {target: parts - self._brought[target] for target, parts in self.parts.items()}

    def follow(
        self,
        hand: RobotTruth,
        carrier: RobotTruth | None,
        effector: Effector | None,
        *,
        is_of_others: bool,
        is_late: bool,
    ) -> str | None:
        """Take in what a hand did in this step, also for another cell; the sentence about what cannot be.

        `is_late`: its carrier has set out for elsewhere since it was told to. It may have the part that it
        was to take, or none, and nobody can see whether it let go before its carrier left.
        """
        name = hand.robot.name
        before, now = self._held[name], _holds(hand)
        self._held[name] = now
        found = [] if carrier is None else self._found(self._hands[name], carrier)
        if effector is not None and self.cell.piece_check is not False and self._has_none(effector, found):
            return None
        if now == before:
            return None
        closes_late = now and carrier is not None and self._is_on_its_way(name, carrier)
        if is_late or (closes_late and not is_of_others):
            self.is_doubtful |= bool(found) or not is_of_others
            return None
        sentence = self._too_early(name, carrier) if now and carrier is not None else None
        if len(found) != 1:
            # what another cell puts down where this one has no place is no part of its places
            is_elsewhere = not (now or is_of_others or self._is_at_uncounted_place(name, carrier))
            self.is_doubtful |= bool(found) or is_elsewhere
            return sentence
        place = self._places[found[0]]
        if is_of_others and place.by_people:
            return None  # people see to it for each task
        sentence = self._move(place, name, -1 if now else 1, is_of_others=is_of_others)
        if is_of_others:
            self._moved_by_others.add(place.target)
        else:
            self._note_as_left(place.target)
        return sentence

    def _has_none(self, effector: Effector, found: list[str]) -> bool:
        """True where an effector takes or puts nothing, as it has closed beside the part or has lost it.

        Nobody could know that unless its board said so on the way. Of a station nobody asks its sensor.
        """
        arm, name = effector.arm, effector.arm.robot.name
        if arm.on and not arm.was_on and not arm.holding:
            if self._rack.isdisjoint(found):
                self.empty_handed[name] = found
            return name in self.empty_handed
        if arm.on and arm.was_on and arm.was_holding and not arm.holding:
            self.empty_handed[name] = None
            self.is_doubtful |= bool(self._rack) or effector.felt is not True
        if arm.on or name not in self.empty_handed:
            return False
        self.is_doubtful |= self.empty_handed.pop(name) != found and effector.felt is not False
        return True

    def close(self, hand: str, carrier: RobotTruth | None) -> None:
        """Take in that a hand is told to close: a part may be at the places where it is, or none any more."""
        self._touched.update(() if carrier is None else self._found(self._hands[hand], carrier))

    def _note_as_left(self, target: str) -> None:
        self._touched.add(target)
        self._left[target] = self._without_people[target]

    def may_have_left(self, targets: Iterable[str]) -> bool:
        """True where its last task, which is not done, may have left a part at one of these places."""
        return self.has_failed and (self.is_doubtful or not self._touched.isdisjoint(targets))

    def make(self, device: str) -> str | None:
        """Take in that a device is told to make a part: from then on it may be there."""
        targets = [each.target for each in self._places.values() if each.device == device]
        free = [each for each in targets if self.parts[each] < self.capacity(each)]
        for target in free[:1]:
            self.parts[target] += 1
            self._note_as_left(target)
        return f"{device} makes a part, and has no room for it" if targets and not free else None

    def _move(self, place: Place, name: str, moved: int, *, is_of_others: bool) -> str | None:
        """Count a part that a hand took or put; the sentence about what cannot be."""
        now = moved < 0
        if place.target in self._rack:
            return self._move_in_rack(place.target, name, taken=now, is_of_others=is_of_others)
        self.parts[place.target] += moved
        self._began_with[place.target] += moved * is_of_others
        if now and self.parts[place.target] < 0:
            return f"{name} takes hold of a part at {place.target}, where none is"
        if self.parts[place.target] > place.holds:
            return f"{name} lets go of a part at {place.target}, which has {place.holds} already"
        return None

    def _move_in_rack(self, target: str, name: str, *, taken: bool, is_of_others: bool) -> str | None:
        there, self.parts[target] = self.parts[target], 0 if taken else 1
        self.is_doubtful |= taken and not there
        is_second = bool(there) and not taken and target in self._put
        if not is_of_others:
            self._put = self._put - {target} if taken else self._put | {target}
        return f"{name} lets go of a second part of its task at {target}" if is_second else None

    def see(self, giver: RobotTruth) -> None:
        """Take in where the robot stands that brings parts."""
        if isinstance(giver, MobileTruth) and not giver.moving:
            self.came |= {giver.node, giver.counted} if giver.strayed else {giver.node}

    def _too_early(self, name: str, carrier: RobotTruth) -> str | None:
        """The sentence about a part that is taken at the handover before a robot has brought it."""
        handover, giver = self.cell.handover, self._giver
        if handover is None or giver is None or self._hands[name].robot.name != handover.taker:
            return None
        targets = self._hands[name].targets
        here = [each for each in handover.targets if targets[each].name in carrier.here | carrier.stood]
        paths = self.cell.reach[handover.giver].paths
        ends = {path.nodes[-1] for path in paths if handover.after(path.code) in here}
        if not here or giver.evidence is not Evidence.IDS or not ends.isdisjoint(self.came):
            return None
        return f"{name} takes hold of a part at {here[0]}, which {giver.name} has not brought"

    def _is_at_uncounted_place(self, name: str, carrier: RobotTruth | None) -> bool:
        """True at a target where parts come and go, and nobody counts them."""
        robot = self._hands[name].robot.name
        poses = part_poses(self.cell, robot, puts=True)
        return (
            carrier is not None and poses is not None and not poses.isdisjoint(carrier.here | carrier.stood)
        )

    def set(self, parts: Mapping[str, int]) -> None:
        """Have a person see to it that so many parts are at places.

        A task that is at work meanwhile has not done that, and began with so many more or less. Where it
        fails, the plant may ask about an output at which they say that parts are.
        """
        for target, now in parts.items():
            brought = now - self.parts[target]
            self._began_with[target] += brought
            self._brought[target] += brought
            self.parts[target] = now
            if brought > 0 and self._places[target].output:
                self._touched.add(target)

    def capacity(self, target: str) -> int:
        """The most parts that a place can have."""
        return self._places[target].holds

    def depends_on(self, robot: str) -> bool:
        """False for a robot that only brings parts, wherever it is."""
        handover = self.cell.handover
        only_brings = handover is not None and handover.giver == robot and not self.has(robot)
        return not only_brings or any(place.device == robot for place in self._places.values())

    def has(self, hand: str) -> bool:
        """True for a hand of one of its robots."""
        return hand in self._held

    @property
    def hands(self) -> list[str]:
        """The hands of its robots."""
        return list(self._hands)

    @property
    def tools(self) -> list[str]:
        """The hands that are devices of their own, which take their time to close and to open."""
        return [name for name, space in self._hands.items() if name != space.robot.name]

    def carrier(self, hand: str) -> str:
        """The robot that carries a hand."""
        return self._hands[hand].robot.name

    def _is_on_its_way(self, hand: str, carrier: RobotTruth) -> bool:
        """True for the carrier of a hand where it stands at no target of this cell, place or not."""
        if carrier.cell.name != self.cell.name:
            return not any(map(carrier.stands_at, (pose.q for pose in self._hands[hand].targets.values())))
        return not carrier.here | carrier.stood

    def _found(self, space: Workspace, carrier: RobotTruth) -> list[str]:
        """The places where a hand is, and the other targets that its carrier cannot tell from them.

        What is known of a carrier that cells share has the targets of the first of them only.
        """
        stands = carrier.here | carrier.stood
        is_shared = carrier.cell.name != self.cell.name
        here = {
            target: pose.q
            for target, pose in space.targets.items()
            if (carrier.stands_at(pose.q) if is_shared else pose.name in stands)
        }
        places = {target: q for target, q in here.items() if target in self._places}
        others = [target for target, q in here.items() if q not in places.values()]
        return [*places, *others] if places else []


class PlacesTruth:
    """Truth of the places of all cells that have some; `wrong`: sentences about this step, and `missed` those
    about commands that the plant refused for a part, or for room, that there is.
    """

    def __init__(
        self,
        world: World,
        robots: Mapping[str, RobotTruth],
        effectors: Mapping[str, Effector],
        *,
        mistaken: Callable[[RobotTruth], bool],
        released: Callable[[str], bool],
    ) -> None:
        self.wrong: list[str] = []
        self.missed: list[str] = []
        self.cells = {cell.name: CellPlaces(cell, robots) for cell in world.model.cells if cell.counted}
        self._world = world
        self._scopes = Scopes(world.model)
        self._robots = robots
        self._effectors = effectors
        self._mistaken = mistaken
        self._released = released
        self._before: dict[str, Grip] = {}  # by the books, before this step
        self._grips: dict[str, Grip] = {}
        self._told_at: dict[tuple[str, bool], float] = {}  # when a hand was told to close, or to open
        self._set_out_at: dict[str, float] = {}  # when a robot was set in motion last
        self._seen: tuple[object, int] | None = None  # whose books, and which version of them
        self._cells_of: dict[str, list[CellPlaces]] = {}
        self._brought_to: dict[str, CellPlaces] = {}  # by the robot that brings
        for places in self.cells.values():
            for robot in places.cell.robots:
                if places.depends_on(robot.name):
                    self._cells_of.setdefault(robot.name, []).append(places)
            if places.cell.handover is not None:
                self._brought_to[places.cell.handover.giver] = places

    def forget(self) -> None:
        """Forget what happened in the step before."""
        self.wrong = []
        if self.missed:
            self.missed = []
        self._before = self._grips
        effectors = effectors_of(self._world.plant)
        if self._seen != (effectors, effectors.version):
            self._seen, self._grips = (effectors, effectors.version), effectors.grips.by_holder

    def follow(self, changed: Iterable[RobotTruth]) -> None:
        """Take in what robots did in this step."""
        changed = list(changed)
        moved = [each.robot.name for each in changed if any(act.moves for act in each.acts)]
        self._set_out_at.update(dict.fromkeys(moved, self._world.now))
        for robot in changed:
            name = robot.robot.name
            if name in self._brought_to:
                self._brought_to[name].see(robot)
            for places in self._cells_of.get(name, ()):
                places.is_doubtful |= self._is_doubtful(robot)
                if not places.has(name):
                    continue
                carrier = self._robots.get(places.carrier(name))
                is_of_others = self._is_of_others(name, places.cell)
                is_late = self._is_late(robot, places.carrier(name))
                effector = self._effectors.get(name)
                found = places.follow(robot, carrier, effector, is_of_others=is_of_others, is_late=is_late)
                if found is not None and not places.is_doubtful and not self._released(name):
                    self.wrong.append(found)

    def command(self, command: Command) -> None:
        """Take in that the plant tells a hand to close or to open, or a device to make a part."""
        if isinstance(command, Switch) and command.grips is not None:
            self._told_at[command.robot, command.grips] = self._world.now
            for places in self._cells_of.get(command.robot, ()) if command.grips else ():
                if places.has(command.robot):
                    places.close(command.robot, self._robots.get(places.carrier(command.robot)))
        for places in self.cells.values() if command.makes_part else ():
            found = places.make(command.robot)
            if found is not None and not places.is_doubtful:
                self.wrong.append(found)

    def was_told_to_open(self, hand: str, *, since: float) -> bool:
        """True for a hand that was told to open at this time (s) or later."""
        return self._told_at.get((hand, False), -math.inf) >= since

    def end(self, entry: Entry) -> None:
        """Take in how a command ended: nobody knows of an order to make a part that no device accepted."""
        if entry.command.makes_part and entry.state is not State.DONE and entry.accepted_at is None:
            for places in self.cells.values():
                places.is_doubtful |= places.makes_parts and places.depends_on(entry.command.robot)

    def _is_late(self, hand: RobotTruth, carrier: str) -> bool:
        """True where the carrier of a hand has set out since the hand was told to be as it is."""
        told_at = self._told_at.get((hand.robot.name, _holds(hand)), math.inf)
        return self._set_out_at.get(carrier, -math.inf) > told_at

    def take_refusal(self, entry: Entry) -> None:
        """Take in that a command did not leave, where that was for a place: is it as the plant says?

        Nothing is said in the middle of a grip, of which the plant cannot know yet how it ends.
        """
        trouble = None if entry.failure is None else trouble_in(entry.failure.sentence)
        places = self.cells.get(entry.cell)
        if trouble is None or places is None or places.is_doubtful or self._is_in_grip(places):
            return
        target = str(trouble.values["place"])
        truly, most = places.parts[target], places.capacity(target)
        if truly if trouble.key == EMPTY.key else truly < most:
            self.missed.append(f"{trouble}, and truly {target} has {truly} of {most}")

    def take_answer(self, answer: OperatorAnswer) -> None:
        """Take in what a person did before they said it: they put parts at a place, or took them out."""
        self._set(with_common_places(self._scopes.parts(answer), self._world.model.cells))

    def restart(self, words: Iterable[object], kept: Mapping[str, str]) -> None:
        """Begin with a new plant: what a person said in the step in which the old one died is so if it was
        kept, though nobody was answered. Nobody knows of the order to make a part whether it had left.
        """
        for places in self.cells.values():
            places.is_doubtful |= places.makes_parts
        for word in words:
            if isinstance(word, OperatorRequest) and word.verb in (Verb.LOAD, Verb.UNLOAD):
                named = with_common_places(self._scopes.parts(word), self._world.model.cells)
                if all(_are_kept(parts, kept.get(name, "")) for name, parts in named.items()):
                    self._set(named)

    def task(self, change: TaskChanged) -> None:
        """Take in the plant's word on a task."""
        places = self.cells.get(change.cell or "")
        if places is None or change.request is not None:
            return
        if change.state is TaskState.RUNNING:
            run = self._world.plant.cells[places.cell.name]
            order = text.parse(change.text, self._world.model)
            in_grip = filter(self._closes_or_opens, places.tools)
            recipe = self._world.model.cell(places.cell.name).recipe(order.recipe)
            places.begin(change.task, recipe, places_of(run).counts, in_grip)
            if places.cell.handover is not None and places.cell.handover.giver in self._robots:
                places.see(self._robots[places.cell.handover.giver])
        elif change.state is TaskState.DONE:
            places.end()

    def _set(self, named: Mapping[str, Mapping[str, int]]) -> None:
        """Take in how many parts are at places. In the middle of a grip nobody knows whether a person counted
        that part: no report says whether the effector moved before the person looked.
        """
        for name, parts in named.items():
            self.cells[name].set(parts)
            was_in_grip = any(self._before.get(hand) is Grip.SWITCHING for hand in self.cells[name].hands)
            self.cells[name].is_doubtful |= was_in_grip or self._is_in_grip(self.cells[name])

    def _is_of_others(self, hand: str, cell: Cell) -> bool:
        """True while another cell has a hand that it shares with this one."""
        return hand in cell.shared and self._world.plant.zones.holder(hand) not in (None, cell.name)

    def _is_in_grip(self, places: CellPlaces) -> bool:
        grips = grips_of(self._world.plant)
        switching = any(grips[hand] is Grip.SWITCHING for hand in places.hands)
        return switching or any(map(self._closes_or_opens, places.tools))

    def _closes_or_opens(self, hand: str) -> bool:
        """True while a hand that is a device of its own closes or opens."""
        robot = self._robots.get(hand)
        return robot is not None and robot.body.next_change_us is not None

    def _is_doubtful(self, robot: RobotTruth) -> bool:
        """True where nobody can know what a robot did: it lies, lost its power, somebody was at it, or its
        effector is stuck and nobody reports anything of that.
        """
        lies = any(
            number > 0 and board == robot.robot.mqtt for (board, _), number in self._world.deceptions.items()
        )
        by_hand = robot.taken_away or getattr(robot, "by_hand", False) or getattr(robot, "opened", False)
        stuck = getattr(robot.body, "stuck", False) and robot.robot.has_effector
        unnoticed = stuck and robot.robot.evidence is not Evidence.IDS
        return lies or robot.lost_power or by_hand or unnoticed or self._mistaken(robot)


def kept_parts(text: str) -> dict[str, int]:
    """The parts at places in what a plant keeps of a cell, by target; hands are in it, too."""
    pairs = (word.partition("=") for word in text.split())
    return {target: int(number) for target, at, number in pairs if at}


def _are_kept(parts: Mapping[str, int], text: str) -> bool:
    kept = kept_parts(text)
    return all(kept.get(target, 0) == number for target, number in parts.items())


def _holds(hand: Any) -> bool:
    """True while a hand is closed around something, as far as it can know."""
    return bool(hand.on if hand.robot.has_effector else hand.held)
