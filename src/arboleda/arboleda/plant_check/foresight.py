"""Foresight: the facts of a cell after each command of a recipe, as far as they are certain without a run."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from arboleda.model.commands import Command, Motion, Switch
from arboleda.model.facts import Value, shown
from arboleda.model.plant_model import Cell, Interlock, Place, Pose, Workspace
from arboleda.plant_file.declared_kinds import verbs_of

from .notation import Notation, before

HELD, TAKEN, AT, OVER, HAD = "=held", "=taken", "=at", "=over", "=had"
ANSWER = "=answer"  # the answer to a question; after the name of a verb, the last answer to it
ASKER = "=asker"  # after the name of a verb, the step that asked it last
CHANGE, LEAST, MOST = "=change", "=least", "=most"
"""Keys beside facts. A hand holds a part (HELD), which it took at a target (TAKEN). A robot is at a target
(AT), or over it (OVER). The task has taken a shared device (HAD). Since the task began, the number of parts
at a place has changed by CHANGE, and never by less than LEAST or by more than MOST."""
OF_PLACES = (CHANGE, LEAST, MOST)
SceneKey = tuple[str, str]


@dataclass(frozen=True, kw_only=True)
class Scene:
    """The values that are certain at one moment on a path through a recipe; all others are not."""

    values: Mapping[SceneKey, Value] = field(default_factory=dict)

    def get(self, name: str, what: str) -> Value | None:
        return self.values.get((name, what))

    def has(self, values: Mapping[SceneKey, Value]) -> bool:
        return values.items() <= self.values.items()

    def put(self, changes: Mapping[SceneKey, Value]) -> Scene:
        return Scene(values={**self.values, **changes})

    def without(self, keys: set[SceneKey]) -> Scene:
        return Scene(values={key: value for key, value in self.values.items() if key not in keys})

    @cached_property
    def mark(self) -> frozenset[tuple[SceneKey, Value]]:
        """The key by which equal scenes are one."""
        return frozenset(self.values.items())


def common(scenes: Sequence[Scene]) -> tuple[Scene, ...]:
    """One scene with the values that all of these have; no scene where there are none."""
    if len(scenes) < 2:
        return tuple(scenes)
    return (Scene(values=dict(frozenset.intersection(*(scene.mark for scene in scenes)))),)


class Foresight:
    """Foresight of one cell: the objections to a command in a scene, and the scene after the command.

    `back` has by robot the target to which a recovery brings a part, where the recipe names one. `notation`
    is that of the recipe, in which an objection says what to write.
    """

    def __init__(self, cell: Cell, back: Mapping[str, str], notation: Notation) -> None:
        self.cell = cell
        self.back = back
        self.notation = notation
        self.places = {place.target: place for place in cell.places}
        self._free = [each for each in cell.interlocks if each.free_while and each.device not in cell.shared]

    @cached_property
    def hands(self) -> dict[str, Workspace]:
        """The workspaces by the name of the device that holds parts in them."""
        return {space.hand.name: space for space in self.cell.spaces if space.hand.held_fact}

    @cached_property
    def hands_of(self) -> set[str]:
        """The robots that hold parts."""
        return {space.robot.name for space in self.hands.values()}

    def begin(self) -> Scene:
        """The scene at the begin of a task: hands hold nothing, and no part has come or gone."""
        numbers = {(target, what): 0 for target in self.places for what in OF_PLACES}
        return Scene(values={**numbers, **{(hand, HELD): False for hand in self.hands}})

    def home(self, robot: str) -> str:
        """The target at which a robot waits."""
        space = self.cell.reach[robot]
        return next(name for name, pose in space.targets.items() if pose == space.home)

    def touched(self, command: Command) -> set[SceneKey]:
        """The facts and places that a command may change."""
        asked = command.word + ANSWER, command.word + ASKER
        keys = {(command.robot, what) for what in (HELD, TAKEN, AT, OVER, *asked, *dict(command.sets))}
        if command.makes_part or (isinstance(command, Switch) and command.grips is not None):
            keys |= {(target, what) for target in self.places for what in OF_PLACES}
        return keys

    def objections(self, command: Command, scene: Scene) -> Iterator[str]:
        """The mistakes of a command in a scene that are certain."""
        yield from self._unmet(command, scene)
        if isinstance(command, Switch) and command.grips is not None and command.robot in self.hands:
            yield from self._by_hand(command, scene)
        if isinstance(command, Motion) and command.robot in self.cell.reach:
            yield from self._on_move(command, scene)
        made_at = _made_at(self.cell, command)
        if len(made_at) == 1 and not self._can(scene, made_at[0], +1):
            target = made_at[0].target
            yield f"has {command.robot} {command.word} a part at {target}, which is full already"
        yield from self._closing(command, scene)

    def after(self, command: Command, scene: Scene) -> Scene:
        """The scene once a command is done."""
        scene = scene.put({(command.robot, fact): value for fact, value in command.sets})
        if isinstance(command, Motion) and command.robot in self.cell.reach:
            return self._gone(command, scene)
        if isinstance(command, Switch) and command.grips is not None:
            return self._taken(command, self._handled(command, scene))
        made_at = _made_at(self.cell, command)
        if len(made_at) == 1:
            return self._moved(scene, made_at[0].target, +1)
        return scene.without({(each.target, what) for each in made_at for what in OF_PLACES})

    def _taken(self, command: Switch, scene: Scene) -> Scene:
        """The scene with HELD and TAKEN of a hand after it gripped or let go."""
        was, here = scene.get(command.robot, HELD), self._here(command.robot, scene)
        scene = scene.put({(command.robot, HELD): bool(command.grips)})
        if command.grips and was is True:
            return scene
        scene = scene.without({(command.robot, TAKEN)})
        return scene.put({(command.robot, TAKEN): here}) if command.grips and here is not None else scene

    def _handled(self, command: Switch, scene: Scene) -> Scene:
        """The scene once a hand has taken hold, or let go, of a part."""
        if command.robot not in self.hands:
            return scene
        here, held = self._here(command.robot, scene), scene.get(command.robot, HELD)
        if held == command.grips:
            return scene
        if held is None or here is None:
            doubtful = self.places if here is None else {str(here)}
            return scene.without({(target, what) for target in doubtful for what in OF_PLACES})
        if here not in self.places:
            return scene
        return self._moved(scene, str(here), -1 if command.grips else +1)

    def _gone(self, command: Motion, scene: Scene) -> Scene:
        keys = (command.robot, AT), (command.robot, OVER)
        goal, over = self._goal(command), self._goal(command, is_over=True)
        ends = zip(keys, (goal, goal or over), strict=True)
        scene = scene.without(set(keys)).put({key: target for key, target in ends if target is not None})
        return scene.put(
            {key: value for key, value in self._let_in(command.robot, goal) if key not in scene.values}
        )

    def _let_in(self, robot: str, target: str | None) -> Iterator[tuple[SceneKey, Value]]:
        """The facts that let a robot into the zones of a target, if verbs alone change them."""
        for lock in self._locks(robot, target):
            device = next(each for each in self.cell.robots if each.name == lock.device)
            names = {name for verb in verbs_of(device).values() for name, _ in verb.sets}
            for fact, value in lock.free_while:
                if fact in names:
                    yield (lock.device, fact), value

    def _locks(self, robot: str, target: str | None) -> Iterator[Interlock]:
        """The machines that keep a robot out of the zones of a target by their facts."""
        zones = self.cell.reach[robot].targets[target].zones if target is not None else ()
        return (lock for lock in self._free if lock.zone in zones and lock.device != robot)

    def _moved(self, scene: Scene, place: str, parts: int) -> Scene:
        if scene.get(place, CHANGE) is None:
            return scene
        change, least, most = (int(scene.get(place, what) or 0) for what in OF_PLACES)
        change += parts
        return scene.put(
            {(place, CHANGE): change, (place, LEAST): min(least, change), (place, MOST): max(most, change)}
        )

    def _goal(self, command: Motion, *, is_over: bool = False) -> str | None:
        """The target to which, or over which, a robot goes; of several, one that is a place."""
        targets = self.cell.reach[command.robot].targets
        ends = {name: pose.above if is_over else pose.q for name, pose in targets.items()}
        names = [name for name, end in ends.items() if command.way and end == command.way[-1]]
        return next((name for name in names if name in self.places), next(iter(names), None))

    def _here(self, hand: str, scene: Scene) -> Value | None:
        space = self.hands.get(hand)
        return None if space is None else scene.get(space.robot.name, AT)

    def _unmet(self, command: Command, scene: Scene) -> Iterator[str]:
        others = [
            (each.other, each.fact, each.value)
            for each in self.cell.needs
            if (each.device, each.word) == (command.robot, command.word)
        ]
        for name, fact, value in [*((command.robot, *need) for need in command.needs), *others]:
            current = scene.get(name, fact)
            if current is not None and current != value and name not in self.cell.shared:
                needed, is_so = f"{fact} of {name} to be {shown(value)}", shown(current)
                unmet = f"has {command.robot} {command.word}, which needs {needed}, where it is {is_so}"
                yield unmet + before(self.notation.sets(name, fact, value))

    def _by_hand(self, command: Switch, scene: Scene) -> Iterator[str]:
        hand, here = command.robot, self._here(command.robot, scene)
        held, place = scene.get(hand, HELD), self.places.get(str(here))
        if held is True and command.grips:
            yield from self._second_part(hand, here, scene)
        if held is None or here is None or held == command.grips:
            return
        does = "take hold" if command.grips else "let go"
        if place is None:
            at_home = self.cell.places and here == self.home(self.hands[hand].robot.name)
            yield from [f"has {hand} {does} of a part at {here}, where none lies"] if at_home else []
        elif not self._can(scene, place, -1 if command.grips else +1):
            why = "where nothing can be" if command.grips else "which is full already"
            yield f"has {hand} {does} of a part at {here}, {why}"

    def _second_part(self, hand: str, here: Value | None, scene: Scene) -> Iterator[str]:
        """The objection to a second part that a hand takes at another target; cells with places refuse it."""
        taken = scene.get(hand, TAKEN)
        if self.places and None not in (here, taken) and here != taken:
            yield f"has {hand} take hold of a part at {here} while it holds one from {taken}"

    def _can(self, scene: Scene, place: Place, parts: int) -> bool:
        """True where a place can give or take a part, with some number of parts at the beginning."""
        after = self._moved(scene, place.target, parts)
        first = place.holds if place.supply else 0 if place.output else None
        lowest, highest = (0, place.holds) if first is None else (first, first)
        _, least, most = (int(after.get(place.target, what) or 0) for what in OF_PLACES)
        return max(lowest, -least) <= min(highest, place.holds - most)

    def _on_move(self, command: Motion, scene: Scene) -> Iterator[str]:
        robot, space = command.robot, self.cell.reach[command.robot]
        here = self.places.get(str(scene.get(robot, AT)))
        holding = space.hand.name, None if here is None else here.device
        if here is not None and all(name is not None and scene.get(name, HELD) for name in holding):
            held = f"has {robot} leave {here.target} with a part that {here.device} still holds"
            device = next(each for each in self.cell.robots if each.name == here.device)
            yield held + before(self.notation.lets_go(device))
        goal = self._goal(command)
        for is_so, value in self._locked(robot, goal, scene):
            yield f"has {robot} go to {goal} where {is_so}; it has to be {value}"
        over, back = goal or self._goal(command, is_over=True), self._return_target(space, scene)
        for is_so, value in self._locked(robot, back, scene) if over is not None else ():
            carries = f"has {robot} go to {over} with a part that goes back to {back} after a failure"
            yield f"{carries}, where {is_so}; it has to be {value}, or brings_back_to another target"

    def _return_target(self, space: Workspace, scene: Scene) -> str | None:
        """The target to which a recovery would bring what a robot holds for certain."""
        hand, robot = space.hand.name, space.robot.name
        if robot not in self.hands_of or scene.get(hand, HELD) is not True:
            return None
        taken = self.back.get(robot) or scene.get(hand, TAKEN)
        return None if taken is None else str(taken)

    def _locked(self, robot: str, target: str | None, scene: Scene) -> Iterator[tuple[str, str]]:
        """The facts that keep a robot out of the zones of a target, each with the value that it must have."""
        for lock in self._locks(robot, target):
            yield from _guarding_facts(lock, scene)

    def _closing(self, command: Command, scene: Scene) -> Iterator[str]:
        for lock in self.cell.interlocks_of(command.robot):
            if lock.is_ended_by(command):
                for name, pose in self._standing(scene):
                    if lock.zone in pose.zones and name != command.robot:
                        stands = f"has {command.robot} {command.word} while {name} stands at {pose.name}"
                        yield stands + before(self.notation.home(name))
                yield from self._shut_out(command, lock.zone, scene)

    def _shut_out(self, command: Command, zone: str, scene: Scene) -> Iterator[str]:
        """The objections to a command that takes a zone in which another machine is."""
        for lock in (each for each in self._free if each.zone == zone and each.device != command.robot):
            for is_so, value in _guarding_facts(lock, scene):
                waits = f"has {command.robot} {command.word} in the zone {zone}, which {lock.device} keeps"
                yield f"{waits} while {is_so}; it has to be {value}, or each has a zone of its own"

    def _standing(self, scene: Scene) -> Iterator[tuple[str, Pose]]:
        for space in self.cell.spaces:
            at = scene.get(space.robot.name, AT)
            if at is not None:
                yield space.robot.name, space.targets[str(at)]


def still_holding(foresight: Foresight, devices: Collection[str], scene: Scene) -> list[str]:
    """An objection to each of these shared devices that holds a part when it is given back."""
    named = (each for each in foresight.cell.robots if each.name in devices)
    return [
        f"gives {each.name} back with a part in it, and fails there"
        + before(foresight.notation.lets_go(each))
        for each in named
        if scene.get(each.name, HELD) is True
    ]


def _guarding_facts(lock: Interlock, scene: Scene) -> Iterator[tuple[str, str]]:
    """The facts by which a machine is in its zone for certain, each with the value that it must have."""
    for fact, value in lock.free_while:
        current = scene.get(lock.device, fact)
        if current not in (None, value):
            yield f"{fact} of {lock.device} is {shown(current)}", shown(value)


def _made_at(cell: Cell, command: Command) -> list[Place]:
    """The places at which a command may make a part."""
    return [each for each in cell.places if command.makes_part and each.device == command.robot]
