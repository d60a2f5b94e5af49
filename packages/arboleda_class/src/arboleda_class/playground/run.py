"""Run of a plant with virtual devices: moved tick by tick, so that the same acts give the same run."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from arboleda.dashboard.page_state import PageState
from arboleda.extension import Sentence
from arboleda.model.advice import Hand
from arboleda.model.messages import OperatorAnswer, OperatorRequest, TaskChanged, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.rig import hands
from arboleda.views import twin_view, view
from arboleda.views.resting_cells import RestingCells
from arboleda_proofs.running.fault_desk import BEGAN, INSTANT, OVER
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_proofs.simulator.mishaps import MISHAPS

from .acts import Act, HandLent, MishapBegun, TaskAsked, VerbAsked
from .effects import Provoked, effect

TICK_S = 1 / 16  # exact in binary: a sum of ticks is the same however it was made
LOOK_TICKS = 4  # between two looks of the screen's memory
MINUTE_TICKS = round(60 / TICK_S)

Answer = TaskChanged | OperatorAnswer
Row = dict[str, Any]


class Run:
    """Run: a world from its first moment on. `climate` gives the faults of each minute, besides mishaps;
    `began_unix_s` is what screens take the first moment for."""

    def __init__(self, model: PlantModel, layout: Row, climate: Climate, *, began_unix_s: float) -> None:
        self.tick = 0
        self.answers: dict[str, Answer] = {}  # by the id of the request
        self.state = PageState(layout, [])
        self.snapshot: Row = {}  # the last snapshot that the screen's memory took in
        self.provoked: list[Provoked] = []
        self._faults: list[Row] = []  # what of these the time line tells
        self._names = {robot.mqtt: robot.name for robot in model.robots.values()}
        self._watched = JudgedWorld(model, invariants=())
        self._climate = climate
        self._began_unix_s = began_unix_s
        self._resting = RestingCells(), self._watched.world.plant
        self._watched.world.watchers.append(self._hear)
        self._look()

    @property
    def digest(self) -> str:
        """The digest of all that happened; equal runs have equal ones."""
        return self._watched.trace.digest

    @property
    def positions(self) -> Row:
        """Positions that the twin is drawn from, as `PageApi.positions` has it."""
        world = self._watched.world
        return twin_view.positions(world.plant) | {"now": world.now}

    @property
    def links(self) -> Row:
        """The links, as `PageApi.links` has them."""
        broker = {"address": "MQTT", "connected": self._watched.world.broker.is_up}
        return {"broker": broker, "ros": None, "refused": {}, "standbys": []}

    @property
    def seconds(self) -> float:
        """The duration of the run so far, s."""
        return self._watched.seconds

    def _snapshot(self) -> Row:
        plant = self._watched.world.plant
        if self._resting[1] is not plant:  # another start
            self._resting = RestingCells(), plant
        return view.snapshot(plant, self._resting[0].part) | {"faults": self._faults}

    def outcome(self, number: int) -> Row | None:
        """An operator's act by its number; None if the plant has forgotten it."""
        return view.act_by_number(self._watched.world.plant, number)

    def advance(self) -> None:
        """Let a tick pass."""
        if self.tick % MINUTE_TICKS == 0:
            for fault in self._climate.faults(self.tick // MINUTE_TICKS):
                self._watched.expect(fault)
        self._watched.world.advance(TICK_S)
        self.tick += 1
        if self.tick % LOOK_TICKS == 0:
            self._look()

    def befall(self, act: Act, token: str) -> None:
        """Have an act happen now; the answer to a request comes under its token."""
        world = self._watched.world
        if isinstance(act, TaskAsked):
            world.request_task(act.text, token)
        elif isinstance(act, VerbAsked):
            self._operate(act, token)
        elif isinstance(act, HandLent):
            hands.HANDS[Hand(act.do)](world, act.scope)
        else:
            self._begin(act)

    def _operate(self, act: VerbAsked, token: str) -> None:
        world = self._watched.world
        if act.by_hand and act.verb in hands.BEFOREHAND:
            hands.BEFOREHAND[act.verb](world.manual, act.scope)
        world.tell(
            OperatorRequest(
                at=world.now,
                verb=Verb(act.verb),
                scope=act.scope,
                by_hand=act.by_hand,
                arguments=act.arguments,
                request=token,
            )
        )

    def _begin(self, act: MishapBegun) -> None:
        world, mishap, met = self._watched.world, MISHAPS[act.name], effect(self._watched.world, act)
        name, seconds = self._names.get(act.target, act.target), act.seconds if mishap.lasts else 0.0
        for fault in mishap.of(act.target, at=self.seconds, seconds=seconds):
            self._watched.begin(fault)
        self.provoked.append(Provoked(act=act, name=name, effect=met, at_s=self.seconds, seconds=seconds))
        if mishap.lasts:
            self._note((name, BEGAN(what=mishap.sentence, seconds=seconds)))
            world.at(world.now + seconds, self._note, (name, OVER(what=mishap.sentence)))
        else:
            self._note((name, INSTANT(what=mishap.sentence)))

    def _note(self, fault: tuple[str, Sentence]) -> None:
        """Have the time line tell of a fault: the name of its target, and the sentence."""
        number, (name, sentence) = len(self._faults) + 1, fault
        at = self._watched.world.now
        self._faults.append({"number": number, "at": at, "robot": name, "sentence": sentence})

    def _look(self) -> None:
        self.snapshot = self._snapshot()
        self.state.see(self.snapshot, self._began_unix_s + self.seconds)

    def _hear(self) -> None:
        moment = self._watched.world.moment
        for message in _answers((*moment.last_words, *moment.sent, *moment.unkept)):
            if message.request is not None:
                self.answers[message.request] = message


def _answers(messages: Iterable[Any]) -> Iterable[Answer]:
    return (each for each in messages if isinstance(each, TaskChanged | OperatorAnswer))
