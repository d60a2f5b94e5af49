"""The mappings that a wiring file is made of, and how it is read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, TypeAdapter

from arboleda.plant_file.document import Document
from arboleda.plant_file.robot_models import Number, Pair, Positive, Shape

OnOff = Literal["on", "off"]
Pin = Annotated[int, Field(ge=0, le=39)]
FULL = 4095  # counts of the converter
Counts = Annotated[int, Field(ge=0, le=FULL)]
Range = Annotated[list[Counts], Field(min_length=2, max_length=2)]
Pulse = Annotated[int, Field(ge=400, le=2600)]
DriveValue = OnOff | Number | str | dict[str, dict[str, OnOff | Number]]


class InputShape(Shape):
    pin: Pin | None = None
    analog: str | None = None
    on_above: Number | None = None
    off_below: Number | None = None
    active: Literal["low", "high"] = "high"
    debounce_ms: Annotated[int, Field(ge=0, le=10_000)] = 20


class OutputShape(Shape):
    pin: Pin
    active: Literal["low", "high"] = "high"
    safe: OnOff = "off"
    on_stop: Literal["keep", "safe"] = "keep"


class ServoShape(Shape):
    pin: Pin
    degrees: Pair
    pulse_us: Annotated[list[Pulse], Field(min_length=2, max_length=2)]
    deg_s: Positive


class AnalogShape(Shape):
    pin: Pin
    counts: Range
    means: Pair
    step: Positive
    broken: Range = Field(default_factory=lambda: [0, FULL])


class VerbShape(Shape):
    start: dict[str, DriveValue] = Field(default_factory=dict)
    end: dict[str, DriveValue] = Field(default_factory=dict)
    answers: dict[str, str | dict[str, OnOff]] = Field(default_factory=dict)
    at_least_s: Annotated[float, Field(ge=0, le=3600)] | None = None


FactShape = str | dict[str, str | dict[str, OnOff]]


@dataclass(frozen=True, kw_only=True)
class Wiring:
    """A whole file, its parts by name."""

    inputs: Mapping[str, InputShape]
    outputs: Mapping[str, OutputShape]
    servos: Mapping[str, ServoShape]
    analogs: Mapping[str, AnalogShape]
    facts: Mapping[str, FactShape]
    verbs: Mapping[str, VerbShape]


SECTIONS: dict[str, TypeAdapter[Any] | type[Shape]] = {
    "inputs": InputShape,
    "outputs": OutputShape,
    "servos": ServoShape,
    "analogs": AnalogShape,
    "facts": TypeAdapter(FactShape, config=ConfigDict(strict=True)),
    "verbs": VerbShape,
}


def read(document: Document) -> Wiring:
    """The wiring of a file; ConfigError if a part does not have the shape that it should have."""
    for key in document.keys(()):
        if key not in SECTIONS:
            document.unknown((key,), SECTIONS)
    parts = {section: _parts(document, section, shape) for section, shape in SECTIONS.items()}
    document.finish()
    return Wiring(**parts)


def _parts(document: Document, section: str, shape: TypeAdapter[Any] | type[Shape]) -> dict[str, Any]:
    value = document.value((section,))
    if value is not None and not isinstance(value, dict):
        document.problem((section,), "must be a mapping (key: value)")
    names = document.keys((section,))
    if isinstance(shape, TypeAdapter):
        return {name: document.read_plain(shape, (section, name)) for name in names}
    return {name: document.read(shape, (section, name)) for name in names}
