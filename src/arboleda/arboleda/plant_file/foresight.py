"""Foresight: what is so in a cell after each command of a recipe, as far as that is certain without a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property

from arboleda.model.commands import Command, Motion, Switch
from arboleda.model.facts import Value, shown
from arboleda.model.plant_model import Cell, Place, Workspace

from .foreseen_locks import ForeseenLocks
from .scene import AT, CHANGE, HELD, LEAST, MOST, OF_PLACES, OVER, TAKEN, Key, Scene


class Foresight:
    """Foresight of one cell: what a command cannot do in a scene, and what is so after it.

    `back`: by robot the target to which a recovery brings a part, where its recipe names one.
    """

    def __init__(self, cell: Cell, back: Mapping[str, str]) -> None:
        self.cell = cell
        self.back = back
        self.places = {place.target: place for place in cell.places}
        self._locks = ForeseenLocks(cell)

    @cached_property
    def hands(self) -> dict[str, Workspace]:
        """The workspaces by what holds parts there."""
        return {space.hand.name: space for space in self.cell.spaces if space.hand.held_fact}

    @cached_property
    def hands_of(self) -> set[str]:
        """The robots that hold parts."""
        return {space.robot.name for space in self.hands.values()}

    def begin(self) -> Scene:
        """The scene at the begin of a task: hands hold nothing, and no part has come or gone."""
        numbers = {(target, what): 0 for target in self.places for what in OF_PLACES}
        return Scene(known={**numbers, **{(hand, HELD): False for hand in self.hands}})

    def home(self, robot: str) -> str:
        """The target at which a robot waits."""
        space = self.cell.reach[robot]
        return next(name for name, pose in space.targets.items() if pose == space.home)

    def touched(self, command: Command) -> set[Key]:
        """The facts and places that a command may change."""
        keys = {(command.robot, what) for what in (HELD, TAKEN, AT, OVER, *dict(command.sets))}
        if isinstance(command, Switch) and command.grips is not None:
            keys |= {(target, what) for target in self.places for what in OF_PLACES}
        return keys

    def objections(self, command: Command, scene: Scene) -> Iterator[str]:
        """The mistakes of a command in a scene that are certain."""
        yield from self._unmet(command, scene)
        if isinstance(command, Switch) and command.grips is not None and command.robot in self.hands:
            yield from self._by_hand(command, scene)
        if isinstance(command, Motion) and command.robot in self.cell.reach:
            yield from self._on_the_way(command, scene)
        yield from self._locks.closing(command, scene)

    def after(self, command: Command, scene: Scene) -> Scene:
        """The scene once a command is done."""
        scene = scene.put({(command.robot, fact): value for fact, value in command.sets})
        if isinstance(command, Motion) and command.robot in self.cell.reach:
            return self._gone(command, scene)
        if isinstance(command, Switch) and command.grips is not None:
            return self._taken(command, self._handled(command, scene))
        return scene

    def _taken(self, command: Switch, scene: Scene) -> Scene:
        """The scene with what the hand holds, and where it took that."""
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
        found = zip(keys, (goal, goal or over), strict=True)
        scene = scene.without(set(keys)).put({key: target for key, target in found if target is not None})
        return scene.put(
            {key: value for key, value in self._locks.let_in(command.robot, goal) if key not in scene.known}
        )

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
        found = [name for name, end in ends.items() if command.way and end == command.way[-1]]
        return next((name for name in found if name in self.places), next(iter(found), None))

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
            known = scene.get(name, fact)
            if known is not None and known != value and name not in self.cell.shared:
                needed = f"{fact} of {name} to be {shown(value)}"
                yield f"has {command.robot} {command.word}, which needs {needed}, where it is {shown(known)}"

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
        """A second part in a hand, taken elsewhere than the first; cells with places refuse it."""
        taken = scene.get(hand, TAKEN)
        if self.places and None not in (here, taken) and here != taken:
            yield f"has {hand} take hold of a part at {here} while it holds one from {taken}"

    def _can(self, scene: Scene, place: Place, parts: int) -> bool:
        """True where there is any number of parts to begin with by which a place can give or take one."""
        after = self._moved(scene, place.target, parts)
        first = place.holds if place.supply else 0 if place.output else None
        lowest, highest = (0, place.holds) if first is None else (first, first)
        _, least, most = (int(after.get(place.target, what) or 0) for what in OF_PLACES)
        return max(lowest, -least) <= min(highest, place.holds - most)

    def _on_the_way(self, command: Motion, scene: Scene) -> Iterator[str]:
        robot, space = command.robot, self.cell.reach[command.robot]
        here = self.places.get(str(scene.get(robot, AT)))
        holding = space.hand.name, None if here is None else here.device
        if here is not None and all(name is not None and scene.get(name, HELD) for name in holding):
            yield f"has {robot} leave {here.target} with a part that {here.device} still holds"
        goal = self._goal(command)
        for is_so, value in self._locks.locked(robot, goal, scene):
            yield f"has {robot} go to {goal} where {is_so}; it has to be {value}"
        over, back = goal or self._goal(command, is_over=True), self._way_back(space, scene)
        for is_so, value in self._locks.locked(robot, back, scene) if over is not None else ():
            carries = f"has {robot} go to {over} with a part that goes back to {back} after a failure"
            yield f"{carries}, where {is_so}; it has to be {value}, or brings_back_to another target"

    def _way_back(self, space: Workspace, scene: Scene) -> str | None:
        """The target to which a recovery would bring what a robot holds for certain."""
        hand, robot = space.hand.name, space.robot.name
        if robot not in self.hands_of or scene.get(hand, HELD) is not True:
            return None
        taken = self.back.get(robot) or scene.get(hand, TAKEN)
        return None if taken is None else str(taken)
