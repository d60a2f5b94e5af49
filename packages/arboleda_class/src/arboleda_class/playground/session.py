"""Session: one person with one plant; forward by ticks, and back by running again from the seed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from arboleda.dashboard import outcomes
from arboleda.dashboard.twin.twin import Twin
from arboleda.extension import Face, words
from arboleda.geometry.bodies import Body
from arboleda.model.advice import Hand
from arboleda.model.messages import Verb
from arboleda.model.plant_model import PlantModel
from arboleda.views import view
from arboleda.views.changes import changed
from arboleda.web.languages import texts
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.mishaps import MISHAPS

from .acts import Act, HandLent, MishapBegun, TaskAsked, VerbAsked, act_of, plain
from .film import Film, FilmRun
from .requests import Requests
from .run import LOOK_TICKS, TICK_S, Run
from .strip import HAND, Strip

LONGEST_STEP_S = 60.0  # in which nothing happens
VERBS = frozenset(verb.value for verb in Verb)
HANDS = frozenset(hand.value for hand in Hand)
SUBMIT = "submit"
Row = dict[str, Any]


class Session:
    """Session: takes what a person asks for, and gives frames with what has changed on the page.

    `level` is one of the simulator's levels of faults, drawn from the `seed`. `drawings` are the robots'
    bodies. An act in the past begins another future: what came after it is forgotten. With a `film` it is
    gone through, and acts are refused.
    """

    def __init__(
        self,
        model: PlantModel,
        drawings: Mapping[str, Body],
        *,
        language: str,
        seed: int = 0,
        level: str = "none",
        began_unix_s: float = 0.0,
        film: Film | None = None,
    ) -> None:
        self.layout = view.layout(model) | {"recorded": False, "demo": False, "draft": False}
        self.latest = film.last_tick if film else 0  # of the ticks that can be gone to
        self._film = film
        self._model = model
        self._drawings = drawings
        self._words = words(language)
        self._strip = Strip(self._words, model, began_unix_s=began_unix_s)
        self._climate = Climate.draw(model, seed, level)
        self._began_unix_s = began_unix_s
        self._acts: list[Act] = []
        self._requests = Requests(self._words)
        self._looks = False
        self._drawn: Row = {}
        self.forget()
        self._begin()

    @property
    def tick(self) -> int:
        return self._run.tick

    @property
    def digest(self) -> str:
        """The digest of the run so far."""
        return self._run.digest

    @property
    def scene(self) -> Row:
        """The fixed things that the twin draws; empty where no robot is drawn."""
        return {} if self._twin is None else self._twin.scene

    def look(self, *, on: bool) -> None:
        """Draw the twin in the frames from now on, or no more."""
        self._looks = on
        self._drawn = {}

    def forget(self) -> None:
        """Have the next frame say everything."""
        self._shown: Face = {}
        self._drawn = {}

    def advance(self, ticks: int) -> None:
        """Let time pass; acts of before that are still to come happen again."""
        for _ in range(ticks):
            self._advance()

    def go(self, tick: int) -> None:
        """Go to a tick between the beginning and the latest one."""
        tick = min(max(tick, 0), self.latest)
        if tick < self._run.tick:
            self._begin()
        while self._run.tick < tick:
            self._advance()

    def step(self) -> None:
        """Let time pass until something happens, to the plant or to a step of a tree; or LONGEST_STEP_S."""
        before = self._happened()
        for _ in range(round(LONGEST_STEP_S / TICK_S)):
            self._advance()
            if self._happened() - before or (self._film and self.tick == self.latest):
                return

    def step_back(self) -> None:
        """Go back to what happened last before now."""
        now = self._run.tick
        self.go(max((tick for tick in map(self._shown_at, self._happened()) if tick < now), default=0))

    @property
    def past(self) -> Row:
        """All that the run is made of besides the seed, for `go_on`."""
        return {"acts": [plain(each) for each in self._acts], "tick": self.tick, "latest": self.latest}

    def go_on(self, past: Row) -> None:
        """Go to where a run of this plant and seed was left."""
        self._acts, self.latest = [act_of(each) for each in past["acts"]], past["latest"]
        self.go(past["tick"])

    def take(self, act: str, of: str, more: object = None) -> None:
        """Take a request of the page, in the form of its buttons; anything else is ignored."""
        if self._refused():
            return
        tick = self._run.tick
        if act == SUBMIT:
            task = TaskAsked(tick=tick, text=of)
            self._requests.awaited[self._do(task)] = task
        elif act in VERBS:
            verb = Verb(act)
            arguments = outcomes.arguments_of(verb, more)
            request = VerbAsked(tick=tick, verb=verb, scope=of, by_hand=more is True, arguments=arguments)
            self._requests.awaited[self._do(request)] = request
        elif act == HAND:
            do, _, scope = of.partition(" ")
            if do in HANDS:
                self._do(HandLent(tick=tick, do=do, scope=scope))

    def befall(self, name: str, target: str, seconds: float) -> None:
        """Begin a mishap; one that cannot befall this target is ignored."""
        if not self._refused() and name in MISHAPS and target in MISHAPS[name].targets(self._model):
            self._do(MishapBegun(tick=self._run.tick, name=name, target=target, seconds=seconds))

    def _refused(self) -> bool:
        """Say so where nothing can be asked, as all has happened already."""
        if self._film is not None:
            self._requests.lines.append((texts(self._words.language, "playground")["story_is_over"], False))
        return self._film is not None

    def task_face(self, id: str) -> Face:
        """The page of one task."""
        return self._run.state.task_face(id, self._words.language)

    def frame(self) -> Row:
        """Changes since the last frame: `face` and `twin` for the page's scripts, `said` as answers
        [sentence, good], and the `clock` {tick, latest, tick_s, ends (True where nothing
        follows), marks ([tick, name] of mishaps)}."""
        run = self._run
        face = run.state.face(self._words.language, run.links)
        face |= self._strip.face(run, face)
        patch, self._shown = changed(self._shown, face), face
        return {
            "face": patch,
            "twin": self._twin_patch(),
            "said": self._requests.taken_lines(),
            "clock": {
                "tick": run.tick,
                "latest": self.latest,
                "tick_s": TICK_S,
                "ends": self._film is not None and run.tick == self.latest,
                "marks": [
                    [each.tick, self._strip.name(each)]
                    for each in self._acts
                    if isinstance(each, MishapBegun)
                ],
            },
        }

    def _begin(self) -> None:
        self._run = self._first_moment()
        self._twin = Twin(self.layout["places"], self._drawings) if self._drawings else None
        self._next = 0  # of the acts
        self._requests.forget()

    def _first_moment(self) -> Run | FilmRun:
        if self._film is not None:
            return FilmRun(self._film, self.layout, began_unix_s=self._began_unix_s)
        return Run(self._model, self.layout, self._climate, began_unix_s=self._began_unix_s)

    def _happened(self) -> set[float]:
        """The times at which something happened, s, as the screen's memory keeps them."""
        state = self._run.state
        events = {float(each["at"]) for each in state.chronicle.events}
        return events.union(change.at for memory in state.trees.values() for change in memory.changes)

    def _shown_at(self, unix_s: float) -> int:
        """The tick of the first look by which something was seen."""
        looks = (unix_s - self._began_unix_s) / TICK_S / LOOK_TICKS
        return math.ceil(round(looks, 3)) * LOOK_TICKS

    def _advance(self) -> None:
        while self._next < len(self._acts) and self._acts[self._next].tick <= self._run.tick:
            self._run.befall(self._acts[self._next], str(self._next))
            self._next += 1
        self._run.advance()
        self.latest = max(self.latest, self._run.tick)
        self._requests.hear(self._run)

    def _do(self, act: Act) -> str:
        """Have an act happen with the next tick, and nothing of what once came after it; return its token."""
        self._acts = [each for each in self._acts if each.tick <= act.tick]
        self._acts.append(act)
        self.latest = act.tick
        return str(len(self._acts) - 1)

    def _twin_patch(self) -> Row:
        if self._twin is None or not self._looks:
            return {}
        positions = self._run.positions
        drawn = self._twin.frame(positions, positions["now"])
        patch, self._drawn = changed(self._drawn, drawn), drawn
        return patch
