"""Program of the worker in a browser tab: requests of the page as JSON text, and answers as such."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from arboleda.dashboard.findings import findings
from arboleda.extension import ArboledaError, ConfigError
from arboleda.geometry.bodies import Body
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import in_json
from arboleda.web.languages import spoken
from arboleda_class.exercises.wording import in_story
from arboleda_proofs.campaigns.request import Request
from arboleda_proofs.simulator import mishaps

from . import building, files, judging, markup, plants, programs
from .film import Film
from .session import Session

Row = dict[str, Any]
Progress = Callable[[float], object]
MOST_TICKS = 960  # in one request: a minute
NOON = (2000, 1, 1, 0, 0, 0, 0, 1, -1)  # clocks of the page begin with 00:00:00, whatever the time zone
WORK, STORY = "work", "story"  # plants that are not among `plants.FILES`


def _silent(_: float) -> None:
    """Nobody listens."""


@dataclass(frozen=True, kw_only=True)
class Playable:
    """Playable: a plant that can be opened, with the bodies of its robots; with a `film`, what it did."""

    model: PlantModel
    drawings: dict[str, Body]
    film: Film | None = None


class Tab:
    """Tab: one open page; what cannot be done is answered with a sentence."""

    def __init__(self) -> None:
        self._session: Session | None = None
        self._playables: dict[str, Playable] = {}  # WORK as it was built last, STORY as it was judged last
        self._progress: Progress = _silent

    def hear(self, text: str, progress: Progress = _silent) -> str:
        """Do what a request asks for; {"sentence"} says what cannot be done. What is found wrong is said in
        the `language` of the request. `progress` hears from what takes long which share of it is done, from
        0 to 1."""
        self._progress = progress
        request = json.loads(text)
        try:
            answer = DOES[request["do"]](self, request)
        except ArboledaError as error:
            answer = {"sentence": _translate(request, str(error))}
        return json.dumps(answer, default=in_json)

    def open(self, request: Row) -> Row:
        """Open a plant: its page, and the first frame."""
        name = request["plant"] or plants.FIRST
        language = spoken(request["languages"])
        playable = self._playables.get(name) or _shipped(name)
        self._session = Session(
            playable.model,
            playable.drawings,
            language=language,
            seed=request["seed"],
            level=request["level"],
            began_unix_s=time.mktime(NOON),
            film=playable.film,
        )
        if request.get("past"):
            self._session.go_on(request["past"])
        targets = {} if playable.film else dict(mishaps.possible(playable.model))
        offered = [] if name in self._playables else list(plants.FILES)
        page = markup.html(self._session.layout, language, plants=offered, chosen=name, targets=targets)
        return {"html": page, "page": markup.data(language), "frame": self._session.frame()}

    def advance(self, request: Row) -> Row:
        self._open.advance(min(request["ticks"], MOST_TICKS))
        return self._framed()

    def go(self, request: Row) -> Row:
        self._open.go(request["tick"])
        return self._framed()

    def step(self, _: Row) -> Row:
        self._open.step()
        return self._framed()

    def back(self, _: Row) -> Row:
        self._open.step_back()
        return self._framed()

    def act(self, request: Row) -> Row:
        self._open.take(request["act"], request["of"], request["more"])
        return self._framed()

    def befall(self, request: Row) -> Row:
        self._open.befall(request["name"], request["target"], request["seconds"])
        return self._framed()

    def look(self, request: Row) -> Row:
        self._open.look(on=request["on"])
        return self._framed()

    def scene(self, _: Row) -> Row:
        return {"scene": self._open.scene}

    def task_face(self, request: Row) -> Row:
        return {"face": self._open.task_face(request["id"])}

    def past(self, _: Row) -> Row:
        """The acts and the ticks of the run, for the `past` of another `open` of the same plant."""
        return {"past": self._open.past}

    def digest(self, _: Row) -> Row:
        """The digest of the run so far."""
        return {"digest": self._open.digest}

    def simulate(self, request: Row) -> Row:
        """The digest of a seed of `arboleda simulate` on the packaged plants."""
        return {"digest": Request(cycles=request["cycles"]).setting.run(request["seed"]).digest}

    def build(self, request: Row) -> Row:
        """Build the plant of a person's files; {"problems"} where they are none, and the one before stays."""
        try:
            model, drawings = building.built(request["files"], request["plant"])
        except ConfigError as error:
            return {"problems": [_problem(request, building.problem(each)) for each in error.problems]}
        self._playables[WORK] = Playable(model=model, drawings=drawings)
        return {"problems": []}

    def program(self, request: Row) -> Row:
        """Run a program of a lesson."""
        language = spoken([request.get("language")])
        words = request["arguments"], request["typed"], language
        found = programs.run(request["files"], request["program"], *words)
        problem = found["problem"]
        return found | {"problem": None if problem is None else _problem(request, problem)}

    def judge(self, request: Row) -> Row:
        """Judge a work; the first thing that is not so can be opened as STORY then."""
        verdict, film, model = judging.judged(request["exercise"], request["files"], self._progress)
        for finding in verdict["findings"]:
            finding["seen"] = _translate(request, finding["seen"])
            finding["story"] = [in_story(each, partial(_translate, request)) for each in finding["story"]]
        return verdict | self._filmed(film, model)

    def record(self, request: Row) -> Row:
        """The record that belongs to an exercise, to be opened as STORY."""
        return self._filmed(*judging.record(request["exercise"]))

    def _filmed(self, film: Film, model: PlantModel | None) -> Row:
        self._playables.pop(STORY, None)
        if model is not None:
            self._playables[STORY] = Playable(model=model, drawings=building.drawings(model), film=film)
        return {"film": model is not None}

    def pack(self, request: Row) -> Row:
        """A person's files as a zip; those of an exercise as they are handed in."""
        if request["exercise"]:
            return files.handed_in(request["exercise"], request["student"].strip(), request["files"])
        return files.zipped(request["name"], request["files"])

    def unpack(self, request: Row) -> Row:
        """The files of such a zip."""
        return {"files": files.unzipped(request["data"], request["known"])}

    def _framed(self) -> Row:
        return {"frame": self._open.frame()}

    @property
    def _open(self) -> Session:
        assert self._session is not None  # the page opens a plant first
        return self._session


def _translate(request: Row, text: str) -> str:
    """A finding in the language of a request."""
    return findings(spoken([request.get("language")]))(text)


def _problem(request: Row, problem: Row) -> Row:
    """A problem {file, line, text} in the language of a request."""
    return problem | {"text": _translate(request, problem["text"])}


def _shipped(name: str) -> Playable:
    model = plants.model(name)
    return Playable(model=model, drawings=building.drawings(model))


DOES: dict[str, Callable[[Tab, Row], Row]] = {
    "open": Tab.open,
    "advance": Tab.advance,
    "go": Tab.go,
    "step": Tab.step,
    "back": Tab.back,
    "act": Tab.act,
    "befall": Tab.befall,
    "look": Tab.look,
    "scene": Tab.scene,
    "task_face": Tab.task_face,
    "past": Tab.past,
    "digest": Tab.digest,
    "simulate": Tab.simulate,
    "build": Tab.build,
    "program": Tab.program,
    "judge": Tab.judge,
    "record": Tab.record,
    "pack": Tab.pack,
    "unpack": Tab.unpack,
}
hear = Tab().hear
