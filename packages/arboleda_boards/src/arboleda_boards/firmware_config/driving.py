"""Outputs and settings of an order: fixed values, and those that come with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from arboleda.drivers import DeviceKind, DeviceVerb, Effect, FactType, Slot, Value, shown
from arboleda.plant_file.document import Document, Place

from .naming import unknown
from .shapes import Wiring
from .tables import Action, TableValue
from .values import encoded


class Driving:
    """Driving: resolves outputs and settings for one wiring; problems are kept in the document."""

    def __init__(self, document: Document, wiring: Wiring, kind: DeviceKind) -> None:
        self._document, self._wiring, self._kind = document, wiring, kind
        self._problem = document.problem
        self._facts = {name: at for at, name in enumerate(kind.facts)}

    def sets(self, place: Place, verb: DeviceVerb) -> Iterator[tuple[int, TableValue]]:
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
                yield self._facts[name], TableValue(constant=encoded(type, value))

    def actions(self, place: Place, verb: DeviceVerb, wanted: Mapping[str, object]) -> Iterator[Action]:
        outputs, servos = list(self._wiring.outputs), list(self._wiring.servos)
        if verb.effect is Effect.QUERY and wanted:
            self._problem(place, "a query moves nothing")
        for name, value in wanted.items():
            if name in outputs:
                driven = self._driven((*place, name), verb, value, None)
                yield Action(drive="kOutput", index=outputs.index(name), value=driven)
            elif name in servos:
                if verb.effect is Effect.SWITCH or place[-1] == "end":
                    self._problem(
                        (*place, name), "a servo takes its time: only a motion or a process starts it"
                    )
                driven = self._driven((*place, name), verb, value, self._wiring.servos[name].degrees)
                yield Action(drive="kServo", index=servos.index(name), value=driven)
            else:
                unknown(self._document, (*place, name), name, [*outputs, *servos], "output or servo")

    def _passed_on(self, place: Place, verb: DeviceVerb, parameter: str, type: FactType) -> TableValue:
        """The value of a parameter, passed on as the value of a fact."""
        names = [name for name, _ in verb.parameters]
        at, slot = names.index(parameter), dict(verb.parameters)[parameter]
        if slot.words:
            return TableValue(parameter=at, map=tuple(encoded(type, _as(type, word)) for word in slot.words))
        if slot.type not in (bool, int):
            self._problem(
                place,
                f"this board cannot prove any {slot.allowed()}: list the values of {parameter} in the kind",
            )
        return TableValue(parameter=at)

    def _driven(
        self, place: Place, verb: DeviceVerb, value: object, limits: list[float] | None
    ) -> TableValue:
        """The value for an output or a servo: fixed, a parameter, or one for each value of a parameter."""
        if isinstance(value, dict):
            if len(value) == 1 and (parameter := self._parameter(place, verb, next(iter(value)))) is not None:
                at, type = parameter
                return TableValue(
                    parameter=at,
                    map=tuple(self._mapped(place, type, value[f"${verb.parameters[at][0]}"], limits)),
                )
            self._problem(place, "must be on, off, a number, $parameter or {$parameter: {value: ...}}")
            return TableValue()
        if isinstance(value, str) and value.startswith("$"):
            parameter = self._parameter(place, verb, value)
            return self._straight(place, *parameter, limits) if parameter else TableValue()
        return TableValue(constant=self._level(place, value, limits))

    def _straight(self, place: Place, at: int, type: FactType, limits: list[float] | None) -> TableValue:
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
        return TableValue(parameter=at, map=words if type.type is not bool else ())

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
            unknown(self._document, place, word, names, "value")
            return None
        at = names.index(word)
        return at, verb.parameters[at][1]


def _as(type: FactType, word: Value) -> Value:
    """A word of a parameter as one of the fact; whole numbers count as numbers."""
    return float(word) if type.type is float and isinstance(word, int) else word


def _number_in(limits: list[float]) -> Callable[[object], bool]:
    def fits(value: object) -> bool:
        return isinstance(value, int | float) and limits[0] <= value <= limits[1]

    return fits
