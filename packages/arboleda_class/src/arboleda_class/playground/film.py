"""Films: runs of a plant that a judge has made, kept look by look, for a person to go through."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from arboleda.dashboard.page_state import PageState
from arboleda.engine import Plant
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import START_S
from arboleda.views import twin_view, view

from .acts import Act
from .effects import Provoked
from .run import LOOK_TICKS, TICK_S, Answer

Row = dict[str, Any]


@dataclass
class Film:
    """Film: what screens would have seen of a simulated plant; `plant` is for a World's `make_plant`."""

    _looks: list[tuple[Row, Row]] = field(default_factory=list)  # snapshot and positions
    _plant: Plant | None = None

    def plant(self, model: PlantModel, **made_of: Any) -> Plant:
        """A plant for a start that begins now."""
        self._plant = _FilmedPlant(self, model, **made_of)
        return self._plant

    def take(self, plant: Plant, now: float) -> None:
        """Keep what is seen until now, before the plant makes its next step."""
        due = math.floor((now - START_S) / TICK_S / LOOK_TICKS)
        if due >= len(self._looks):
            look = view.snapshot(plant), twin_view.positions(plant) | {"now": now}
            self._looks += [look] * (due + 1 - len(self._looks))

    @property
    def last_tick(self) -> int:
        return max(len(self._looks), 1) * LOOK_TICKS

    def at(self, tick: int) -> tuple[Row, Row]:
        """The snapshot and the positions of a moment."""
        assert self._plant is not None
        number = math.ceil(tick / LOOK_TICKS)
        if number < len(self._looks):
            return self._looks[number]
        return view.snapshot(self._plant), twin_view.positions(self._plant) | {"now": self._plant.now}


class _FilmedPlant(Plant):
    def __init__(self, film: Film, model: PlantModel, **made_of: Any) -> None:
        super().__init__(model, **made_of)
        self._film = film

    def step(self, now: float, events: Any) -> list[Any]:
        self._film.take(self, now)
        return super().step(now, events)


class FilmRun:
    """FilmRun: a film moved tick by tick, as a Run is; nothing can be asked of it."""

    digest = ""

    def __init__(self, film: Film, layout: Row, *, began_unix_s: float) -> None:
        self.tick = 0
        self.answers: dict[str, Answer] = {}
        self.provoked: list[Provoked] = []
        broker = {"address": "MQTT", "connected": True}
        self.links: Row = {"broker": broker, "ros": None, "refused": {}, "standbys": []}
        self.state = PageState(layout, [])
        self._film = film
        self._began_unix_s = began_unix_s
        self._look()

    @property
    def seconds(self) -> float:
        return self.tick * TICK_S

    def outcome(self, number: int) -> Row | None:
        """No operator's act is followed."""
        return None

    def befall(self, act: Act, token: str) -> None:
        """Nothing befalls what has happened already."""

    def advance(self) -> None:
        """Let a tick pass, if there is one."""
        if self.tick < self._film.last_tick:
            self.tick += 1
            if self.tick % LOOK_TICKS == 0:
                self._look()

    def _look(self) -> None:
        self.snapshot, self.positions = self._film.at(self.tick)
        self.state.see(self.snapshot, self._began_unix_s + self.tick * TICK_S)
