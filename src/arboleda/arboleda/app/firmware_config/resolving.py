"""From a wiring file and the kind that it is for to tables; every mistake with its line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from pathlib import Path

from arboleda.kinds.declared import Device, DeviceVerb, Effect, FactType, Slot
from arboleda.model.facts import Value, shown
from arboleda.model.plant_model import Evidence

from ..plant_file.document import Document, Place, nearest
from ..user_file import read_bytes
from . import pins
from .shapes import Wiring, read
from .tables import Action, Fact, Given, Reading, Row, Tables, Verb
from .values import encoded, named, sayable

LARGEST = 100_000
OTHERWISE = "else"
TOLD = "told"
MOST = {"inputs": 16, "outputs": 16, "servos": 4, "analogs": 4}
MOST_FACTS, MOST_VALUES = 16, 6
MOST_TRIED = 12  # inputs of one fact, all of whose states are tried


def tables(device: Device, path: Path) -> Tables:
    """ConfigError with every problem of the file."""
    document = Document(str(path), read_bytes(path, LARGEST), path.parent)
    resolver = Resolver(document, device, read(document))
    made = resolver.tables()
    document.finish()
    return made


class Resolver:
    """Reads one file for one device; problems are kept in the document."""

    def __init__(self, document: Document, device: Device, wiring: Wiring) -> None:
        self._document, self._device, self._kind, self._wiring = document, device, device.kind, wiring
        self._inputs = {name: at for at, name in enumerate(wiring.inputs)}
        self._analogs = {name: at for at, name in enumerate(wiring.analogs)}
        self._facts = {name: at for at, name in enumerate(self._kind.facts)}

    def tables(self) -> Tables:
        self._check_parts()
        self._same_names(("facts",), self._wiring.facts, self._kind.facts, "fact")
        self._same_names(("verbs",), self._wiring.verbs, self._kind.verbs, "verb")
        facts = tuple(self._fact(name, type) for name, type in self._kind.facts.items())
        told = {fact.name for fact in facts if fact.source == "kTold"}
        verbs = tuple(self._verb(verb, told) for verb in self._kind.verbs.values())
        unseen = {name for verb in self._kind.verbs.values() for name, _ in verb.sets} & told
        return Tables(
            name=self._device.mqtt,
            wiring=self._wiring,
            facts=facts,
            verbs=verbs,
            unseen=tuple(name for name in self._kind.facts if name in unseen),
        )

    def _check_parts(self) -> None:
        pins.check(self._document, self._wiring)
        if self._device.evidence is not Evidence.IDS:
            self._problem(
                (), f"{self._device.name} has evidence: {self._device.evidence.value}; this board has ids"
            )
        for section, most in MOST.items():
            if len(getattr(self._wiring, section)) > most:
                self._problem((section,), f"a board has room for {most}")
        if len(self._kind.facts) > MOST_FACTS:
            self._problem(("facts",), f"a board has room for {MOST_FACTS}")
        for name, each in self._wiring.inputs.items():
            self._check_input(("inputs", name), name)
            if each.analog is not None and each.analog not in self._analogs:
                self._unknown(("inputs", name, "analog"), each.analog, self._analogs, "analog input")
        for name, servo in self._wiring.servos.items():
            if servo.degrees[0] >= servo.degrees[1] or servo.pulse_us[0] == servo.pulse_us[1]:
                self._problem(("servos", name), "degrees go from less to more, pulses to another")
        for name, analog in self._wiring.analogs.items():
            if analog.counts[0] == analog.counts[1] or analog.broken[0] >= analog.broken[1]:
                self._problem(("analogs", name), "counts must be two, and broken go from less to more")

    def _check_input(self, place: Place, name: str) -> None:
        each = self._wiring.inputs[name]
        limits = (each.on_above, each.off_below)
        if (each.pin is None) == (each.analog is None):
            self._problem(place, "needs a pin, or an analog input that it compares")
        elif each.analog is not None and (None in limits or limits[1] > limits[0]):  # type: ignore[operator]
            self._problem(place, "needs on_above and off_below, which is not above that")
        elif each.analog is None and limits != (None, None):
            self._problem(place, "on_above and off_below are for one that compares an analog input")

    def _fact(self, name: str, type: FactType) -> Fact:
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

    def _measured(self, name: str, type: FactType, analog: str) -> Fact:
        place = ("facts", name)
        if type.type is not float or type.words:
            self._problem(place, "an analog input says a number; declare the fact as number")
        if analog not in self._analogs:
            self._unknown((*place, "analog"), analog, self._analogs, "analog input")
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
        """Which word inputs say; every state of theirs has to have one."""
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
            self._unknown(place, word, words, "value")
            return 0.0
        return encoded(type, words[word])

    def _when(self, place: Place, when: Mapping[str, str]) -> tuple[tuple[int, bool], ...]:
        for name in when:
            if name not in self._inputs:
                self._unknown(place, name, self._inputs, "input")
        return tuple((self._inputs.get(name, 0), state == "on") for name, state in when.items())

    def _verb(self, verb: DeviceVerb, told: set[str]) -> Verb:
        place: Place = ("verbs", verb.name)
        shape = self._wiring.verbs.get(verb.name)
        if verb.sets_by is not None or verb.takes_s_by is not None:
            self._problem(
                place, "its kind computes in Python what it sets or how long it takes; this board cannot"
            )
        if len(verb.parameters) > MOST_VALUES:
            self._problem(place, f"a board has room for {MOST_VALUES} values of a verb")
        timed = verb.effect is Effect.QUERY or all(name in told for name, _ in verb.sets)
        asked_s = shape.at_least_s if shape else None
        at_least_s = asked_s if asked_s is not None else verb.takes_s if timed else 0.0
        if at_least_s > verb.at_most_s:
            self._problem(
                place, f"at_least_s is {at_least_s:g}, and its kind gives it up after {verb.at_most_s:g} s"
            )
        return Verb(
            told=verb,
            sets=tuple(self._sets(place, verb, told)),
            needs=tuple(
                (self._facts[name], encoded(self._kind.facts[name], value)) for name, value in verb.needs
            ),
            start=tuple(self._actions((*place, "start"), verb, shape.start if shape else {})),
            end=tuple(self._actions((*place, "end"), verb, shape.end if shape else {})),
            answer=self._answer(place, verb),
            at_least_s=at_least_s,
            held_fact=self._facts[verb.held[0]] if verb.holds else -1,
        )

    def _answer(self, place: Place, verb: DeviceVerb) -> Reading:
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

    def _sets(self, place: Place, verb: DeviceVerb, told: set[str]) -> Iterator[tuple[int, Given]]:
        for name, value in verb.sets:
            type = self._kind.facts[name]
            wired = self._wiring.facts.get(name)
            if isinstance(wired, dict) and set(wired) == {"analog"}:
                self._problem(
                    place,
                    f"no measured number is ever exactly the {name} that it sets; let an input compare it",
                )
            if isinstance(value, Slot):
                yield self._facts[name], self._passed_on(place, verb, value.name, type)
            else:
                yield self._facts[name], Given(constant=encoded(type, value))

    def _passed_on(self, place: Place, verb: DeviceVerb, parameter: str, type: FactType) -> Given:
        """The value of a parameter as one of a fact."""
        names = [name for name, _ in verb.parameters]
        at, given = names.index(parameter), dict(verb.parameters)[parameter]
        if given.words:
            return Given(parameter=at, map=tuple(encoded(type, _as(type, word)) for word in given.words))
        if given.type not in (bool, int):
            self._problem(
                place,
                f"this board cannot prove any {given.allowed()}: list the values of {parameter} in the kind",
            )
        return Given(parameter=at)

    def _actions(self, place: Place, verb: DeviceVerb, wanted: Mapping[str, object]) -> Iterator[Action]:
        outputs, servos = list(self._wiring.outputs), list(self._wiring.servos)
        if verb.effect is Effect.QUERY and wanted:
            self._problem(place, "a query moves nothing")
        for name, value in wanted.items():
            if name in outputs:
                given = self._driven((*place, name), verb, value, None)
                yield Action(drive="kOutput", index=outputs.index(name), value=given)
            elif name in servos:
                if verb.effect is Effect.SWITCH or place[-1] == "end":
                    self._problem(
                        (*place, name), "a servo takes its time: only a motion or a process starts it"
                    )
                given = self._driven((*place, name), verb, value, self._wiring.servos[name].degrees)
                yield Action(drive="kServo", index=servos.index(name), value=given)
            else:
                self._unknown((*place, name), name, [*outputs, *servos], "output or servo")

    def _driven(self, place: Place, verb: DeviceVerb, value: object, limits: list[float] | None) -> Given:
        """What an output or a servo is given: fixed, a parameter, or something for each value of one."""
        if isinstance(value, dict):
            if len(value) == 1 and (parameter := self._parameter(place, verb, next(iter(value)))) is not None:
                at, type = parameter
                return Given(
                    parameter=at,
                    map=tuple(self._mapped(place, type, value[f"${verb.parameters[at][0]}"], limits)),
                )
            self._problem(place, "must be on, off, a number, $parameter or {$parameter: {value: ...}}")
            return Given()
        if isinstance(value, str) and value.startswith("$"):
            parameter = self._parameter(place, verb, value)
            return self._straight(place, *parameter, limits) if parameter else Given()
        return Given(constant=self._level(place, value, limits))

    def _straight(self, place: Place, at: int, type: FactType, limits: list[float] | None) -> Given:
        if limits is None and type.type is not bool:
            self._problem(
                place, "an output is on or off: the parameter must be bool, or its values be listed"
            )
        elif limits is not None:
            fits = type.type in (int, float) and all(
                map(_number_in(limits), type.words or (type.lower, type.upper))
            )
            if not fits:
                self._problem(place, f"its values must be numbers from {limits[0]:g} to {limits[1]:g}")
        words = tuple(float(word) for word in type.words if isinstance(word, int | float))
        return Given(parameter=at, map=words if type.type is not bool else ())

    def _mapped(
        self, place: Place, type: FactType, table: Mapping[str, object], limits: list[float] | None
    ) -> Iterator[float]:
        values: tuple[Value, ...] = (False, True) if type.type is bool else type.words
        if {shown(value) for value in values} != set(table):
            self._problem(
                place, f"must have exactly {', '.join(map(shown, values)) or 'the values of a list'}"
            )
            return
        for value in values:
            yield self._level(place, table[shown(value)], limits)

    def _level(self, place: Place, value: object, limits: list[float] | None) -> float:
        if limits is None:
            if value not in ("on", "off"):
                self._problem(place, f"an output is on or off, not {value}")
            return 1.0 if value == "on" else 0.0
        if not isinstance(value, int | float) or not limits[0] <= value <= limits[1]:
            self._problem(place, f"must be degrees from {limits[0]:g} to {limits[1]:g}, is {value}")
            return limits[0]
        return float(value)

    def _parameter(self, place: Place, verb: DeviceVerb, word: str) -> tuple[int, FactType] | None:
        names = [f"${name}" for name, _ in verb.parameters]
        if word not in names:
            self._unknown(place, word, names, "value")
            return None
        at = names.index(word)
        return at, verb.parameters[at][1]

    def _same_names(
        self, place: Place, wired: Mapping[str, object], known: Mapping[str, object], what: str
    ) -> None:
        for name in wired:
            if name not in known:
                self._unknown((*place, name), name, known, f"{what} of a {self._kind.name}")
        for name in known:
            if name not in wired:
                self._problem(place, f"{name} is missing: each {what} of a {self._kind.name} is wired")

    def _unknown(self, place: Place, name: str, known: Mapping[str, object] | list[str], what: str) -> None:
        there = ", ".join(known) or "none"
        self._problem(place, f'there is no {what} "{name}"{nearest(name, known)}; there are: {there}')

    def _problem(self, place: Place, sentence: str) -> None:
        self._document.problem(place, sentence)


def _as(type: FactType, word: Value) -> Value:
    """A word of a parameter as one of the fact, where whole numbers are numbers, too."""
    return float(word) if type.type is float and isinstance(word, int) else word


def _number_in(limits: list[float]) -> object:
    def fits(value: object) -> bool:
        return isinstance(value, int | float) and limits[0] <= value <= limits[1]

    return fits


def _complete(rows: list[Row]) -> bool:
    """Whether there is a row for every state of the inputs that they name."""
    inputs = sorted({input for row in rows for input, _ in row.when})
    if len(inputs) > MOST_TRIED:
        return False
    states = (dict(zip(inputs, state, strict=True)) for state in product((False, True), repeat=len(inputs)))
    return bool(rows) and all(
        any(all(state[input] is on for input, on in row.when) for row in rows) for state in states
    )
