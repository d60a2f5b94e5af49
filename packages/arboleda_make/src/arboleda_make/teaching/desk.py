"""TeachApi of the plant in this process: buttons to the plant, and targets to the draft of its file."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from arboleda.adapters import clock
from arboleda.drivers import Robot
from arboleda.engine import Plant
from arboleda.engine.inspection import beliefs_of
from arboleda.extension import ArboledaError
from arboleda.geometry import bodies
from arboleda.geometry.bodies import Body
from arboleda.model.messages import Jog
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.urdf import robot_urdf
from arboleda.views import view
from arboleda_make.drafts.api import DraftApi
from arboleda_make.teaching.api import Along, Button, State, Target, TeachApi, TeachRefused

from . import devices as taught_devices
from . import targets as taught_targets
from . import tool_path

AHEAD_M = 0.005  # how far ahead the goal of a way without an end is
NO_DRAWING = "the axes of {robot} are not known: {why}"
NO_FILE = "this plant has no file in which a target could be kept; `arboleda new` writes one of your own"
NOWHERE = "where {robot} stands is not known now"
Found = TypeVar("Found")


class PlantLine(Protocol):
    """The plant that runs: it is read between two steps, and given events."""

    @property
    def model(self) -> PlantModel: ...

    def read(self, look: Callable[[Plant], Found]) -> Found: ...

    def post(self, event: Jog) -> None: ...


@dataclass(frozen=True, kw_only=True)
class Way:
    """Goal of a press along an axis that has an end; it stays the same while the button is held."""

    session: int
    number: int
    goal: tuple[float, ...]


class TeachDesk(TeachApi):
    """TeachDesk: buttons and targets of one plant, for threads of a server."""

    def __init__(self, line: PlantLine, draft: DraftApi | None) -> None:
        self._line = line
        self._draft = draft
        self._turns = threading.Lock()
        self._bodies: dict[str, Body] = {}
        self._ways: dict[str, Way] = {}  # by robot, of its last press

    def state(self, cell: str) -> State:
        found = self._line.read(lambda plant: taught_devices.state(plant, cell))
        values = None if self._draft is None else self._draft.state()["values"]
        targets = taught_targets.targets(self._line.model.cell(cell), values)
        axes = {each["name"]: self._draws(each["name"]) for each in found["devices"]}
        devices = [{**each, "axes": axes[each["name"]]} for each in found["devices"]]
        zones = [str(each) for each in (values or {}).get("zones") or {}]
        drafts = self._draft is not None
        return {**found, "devices": devices, "targets": targets, "zones": zones, "drafts": drafts}

    def press(self, cell: str, button: Button) -> State:
        robot = self._robot(cell, button.robot)
        jog = self._jog(cell, robot, button)
        if button.held and (refusal := self._line.read(lambda plant: plant.jog_refusal(jog))) is not None:
            raise TeachRefused(refusal)
        self._line.post(jog)
        return self._line.read(lambda plant: _answer(plant, cell, robot.name))

    def here(self, cell: str, target: Target) -> State:
        if self._draft is None:
            raise TeachRefused(NO_FILE)
        robot = self._robot(cell, target.robot)
        at = self._line.read(lambda plant: beliefs_of(plant)[robot.name].known_position)
        if at is None:
            raise TeachRefused(NOWHERE.format(robot=robot.name))
        spot, values = taught_devices.spot(robot, at), self._draft.state()["values"]
        edits = taught_targets.edits(self._line.model.cell(cell), values, robot, target, spot)
        with self._turns:
            if self._draft.state()["editor"] is None:
                self._draft.take(target.editor, target.name)
            for place, value in edits:
                self._draft.set(target.editor, place, value)
        return {"at": spot, "place": [str(each) for each in edits[0][0]]}

    def _robot(self, cell: str, name: str) -> Robot:
        members = self._line.read(lambda plant: taught_devices.cell_of(plant, cell).cell.robots)
        found = next((each for each in members if each.name == name), None)
        if found is None:
            known = ", ".join(each.name for each in members)
            raise TeachRefused(f"{name} is no device of {cell}; there are {known}")
        return found

    def _jog(self, cell: str, robot: Robot, button: Button) -> Jog:
        goal = None
        if button.goal is not None:
            goal = taught_devices.position(robot, button.goal)
        elif button.along is not None and button.held:
            goal = self._along(robot, button, button.along)
        return Jog(
            at=clock.seconds(),
            cell=cell,
            session=button.session,
            number=button.number,
            robot=robot.name,
            goal=goal,
            word=button.verb,
            values=tuple(button.values.items()),
            held=button.held,
        )

    def _along(self, robot: Robot, button: Button, along: Along) -> tuple[float, ...]:
        """The joints to which a way along an axis leads next, or those at its end."""
        kept = self._ways.get(robot.name)
        if kept is not None and (kept.session, kept.number) == (button.session, button.number):
            return kept.goal
        q = self._line.read(lambda plant: beliefs_of(plant)[robot.name].known_q)
        if q is None:
            raise TeachRefused(NOWHERE.format(robot=robot.name))
        metres = along.sign * (AHEAD_M if along.mm is None else along.mm / 1000)
        body = self._body(robot.name)
        goal = tool_path.moved(body, q, axis=along.axis, frame=along.frame, metres=metres)
        if along.mm is not None:
            self._ways[robot.name] = Way(session=button.session, number=button.number, goal=goal)
        return goal

    def _draws(self, robot: str) -> bool:
        """True where ways along axes are possible: the robot has joints and a drawing."""
        if not self._line.model.robots[robot].joints:
            return False
        try:
            return bool(self._body(robot))
        except ArboledaError:
            return False

    def _body(self, robot: str) -> Body:
        """The drawing of a robot, made once."""
        with self._turns:
            if robot not in self._bodies:
                try:
                    self._bodies[robot] = bodies.read(robot_urdf(self._line.model, robot))
                except (ArboledaError, ValueError) as error:
                    raise TeachRefused(NO_DRAWING.format(robot=robot, why=error)) from error
            return self._bodies[robot]


def _answer(plant: Plant, cell: str, robot: str) -> dict[str, Any]:
    return {
        "teaching": view.teaching(plant, plant.cells[cell]),
        "robot": taught_devices.standing(plant, robot),
    }
