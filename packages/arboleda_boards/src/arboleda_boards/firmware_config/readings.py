"""Sources of facts and answers: the inputs of the board from which they are read."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product

from arboleda.drivers import DeviceVerb, Effect, FactType, Value, shown
from arboleda.plant_file.document import Document, Place

from .naming import unknown
from .shapes import Wiring
from .tables import Fact, Reading, Row
from .values import encoded, named, sayable

OTHERWISE = "else"
TOLD = "told"
MOST_TRIED = 12  # inputs of one fact, all of whose states are tried


class Readings:
    """Readings: resolves the sources of facts for one wiring; problems are kept in the document."""

    def __init__(self, document: Document, wiring: Wiring) -> None:
        self._document, self._wiring = document, wiring
        self._problem = document.problem
        self._inputs = {name: at for at, name in enumerate(wiring.inputs)}
        self._analogs = {name: at for at, name in enumerate(wiring.analogs)}

    def fact(self, name: str, type: FactType) -> Fact:
        place, wired = ("facts", name), self._wiring.facts.get(name, TOLD)
        if not sayable(type):
            self._problem(place, "this board says numbers with four decimals at most")
        if isinstance(wired, str):
            if wired != TOLD:
                self._problem(place, f'must be "{TOLD}", an input, an analog input or words, is "{wired}"')
            elif type.type is str and not type.words:
                self._problem(place, "a text that is no list of words cannot be said by this board")
            return Fact(name=name, type=type, source="kTold")
        if set(wired) == {"analog"}:
            return self._measured(name, type, str(wired["analog"]))
        if set(wired) == {"input"}:
            return self._of_input(name, type, str(wired["input"]))
        return Fact(
            name=name, type=type, source="kInputs", reading=self._reading(place, wired, named(type), type)
        )

    def answer(self, place: Place, verb: DeviceVerb) -> Reading:
        shape = self._wiring.verbs.get(verb.name)
        rows = shape.answers if shape else {}
        if verb.effect is not Effect.QUERY:
            if rows:
                self._problem((*place, "answers"), "only a query is answered")
            return Reading()
        if not verb.answers:
            self._problem(place, "this board answers with words; list them as `answers` of the kind")
            return Reading()
        type = FactType(type=str, words=verb.answers, first=verb.answers[0])
        words = {shown(answer): answer for answer in verb.answers}
        return self._reading((*place, "answers"), rows, words, type)

    def _measured(self, name: str, type: FactType, analog: str) -> Fact:
        place = ("facts", name)
        if type.type is not float or type.words:
            self._problem(place, "an analog input says a number; declare the fact as number")
        if analog not in self._analogs:
            unknown(self._document, (*place, "analog"), analog, self._analogs, "analog input")
        return Fact(name=name, type=type, source="kAnalog", analog=self._analogs.get(analog, 0))

    def _of_input(self, name: str, type: FactType, input: str) -> Fact:
        place = ("facts", name)
        if type.type is not bool:
            self._problem(place, "one input says true or false; declare the fact as bool, or name words")
        rows = (Row(value=1.0, when=self._when((*place, "input"), {input: "on"})),)
        return Fact(name=name, type=type, source="kInputs", reading=Reading(rows=rows, otherwise=0.0))

    def _reading(
        self, place: Place, rows: Mapping[str, object], words: Mapping[str, Value], type: FactType
    ) -> Reading:
        """The table of words for states of inputs; every state has to have one."""
        made, otherwise = [], None
        for word, when in rows.items():
            if word == OTHERWISE:
                otherwise = self._word((*place, word), str(when), words, type)
            elif isinstance(when, dict):
                value = self._word(place, word, words, type)
                made.append(Row(value=value, when=self._when((*place, word), when)))
            else:
                self._problem((*place, word), f"must be inputs that are on or off, is {shown(str(when))}")
        if otherwise is None and not _complete(made):
            self._problem(
                place, f'no word fits some states of its inputs; add "{OTHERWISE}" with one of the kind'
            )
        return Reading(rows=tuple(made), otherwise=otherwise)

    def _word(self, place: Place, word: str, words: Mapping[str, Value], type: FactType) -> float:
        if word not in words:
            unknown(self._document, place, word, words, "value")
            return 0.0
        return encoded(type, words[word])

    def _when(self, place: Place, when: Mapping[str, str]) -> tuple[tuple[int, bool], ...]:
        for name in when:
            if name not in self._inputs:
                unknown(self._document, place, name, self._inputs, "input")
        return tuple((self._inputs.get(name, 0), state == "on") for name, state in when.items())


def _complete(rows: list[Row]) -> bool:
    """True if there is a row for every state of the inputs that the rows name."""
    inputs = sorted({input for row in rows for input, _ in row.when})
    if len(inputs) > MOST_TRIED:
        return False
    states = (dict(zip(inputs, state, strict=True)) for state in product((False, True), repeat=len(inputs)))
    return bool(rows) and all(
        any(all(state[input] is on for input, on in row.when) for row in rows) for state in states
    )
