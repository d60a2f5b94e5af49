"""Fields of forms: what may be typed into each, and the plain value that it means."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import Any

from arboleda.model.errors import Refused
from arboleda.model.facts import Value, shown
from arboleda.model.outside import LINE, quoted
from arboleda.model.recipe import Limits
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.text import OUTSIDE, OUTSIDE_WHOLE

from ..tags import Tag, tag
from ..wording import Text
from .here import Here, labelled

MISSING = Phrase("field.missing", "{name} is missing")
TOO_LONG = Phrase("field.too_long", "{name} has {number} characters; at most {most} are taken")
NO_CHOICE = Phrase("field.no_choice", "{name} cannot be {word}; there are {there}")


@dataclass(frozen=True)
class Field:
    """Field of an act: a text, one of some `choices`, or a number from `lower` to `upper`.

    A number is a whole one where both limits are. `label` names it for people, else its `name` does.
    `choices` are words, or words with their labels. `start` stands in it at first. One that is not
    `required` may be left empty; its value is None then.
    """

    name: str
    label: Text = ""
    _: KW_ONLY
    lower: float | None = None
    upper: float | None = None
    choices: Mapping[str, Text] | Sequence[str] = ()
    start: Value = ""
    required: bool = True

    def __post_init__(self) -> None:
        if (self.lower is None) != (self.upper is None):
            raise ValueError(f"the field {self.name} has one limit; a number has both, lower and upper")

    def read(self, typed: object) -> Value | None:
        """The value of what was typed; Refused says what is wrong with it."""
        word = shown(typed).strip() if isinstance(typed, bool | int | float | str) else ""
        if not word and not self.required:
            return None
        if not word:
            raise Refused(MISSING(name=self._called))
        if self._limits is not None:
            return self._number(word, self._limits)
        if self.choices and word not in self.choices:
            there = tuple(self.choices)
            raise Refused(NO_CHOICE(name=self._called, word=quoted(word), there=there))
        if len(word) > LINE:
            raise Refused(TOO_LONG(name=self._called, number=len(word), most=LINE))
        return word

    def draw(self, here: Here) -> None:
        label = here.say(self._called)
        if self._limits is None:
            with _named(label):
                self._draw_choices(here) if self.choices else self._draw_input("text", maxlength=LINE)
            return
        least, most = (f"{end:g}" for end in (self._limits.lower, self._limits.upper))
        with _named(here.words("tasks.between", what=label, min=least, max=most)):
            self._draw_input("number", min=least, max=most, step="1" if self._limits.whole else "any")

    @property
    def _called(self) -> Sentence | str:
        called = self.label or self.name
        return called() if isinstance(called, Phrase) else called

    @property
    def _limits(self) -> Limits | None:
        if self.lower is None or self.upper is None:
            return None
        whole = isinstance(self.lower, int) and isinstance(self.upper, int)
        return Limits(lower=self.lower, upper=self.upper, whole=whole)

    def _number(self, word: str, limits: Limits) -> Value:
        read = limits.reads(word)
        if read is None:
            outside = OUTSIDE_WHOLE if limits.whole else OUTSIDE
            ends = {"lower": limits.lower, "upper": limits.upper}
            raise Refused(outside(kind=self._called, word=quoted(word), **ends))
        return int(read) if limits.whole else float(read)

    def _draw_input(self, kind: str, **limits: Any) -> None:
        given = {"required": "true"} if self.required else {}
        start = {} if self.start == "" else {"value": shown(self.start)}
        tag("input", type=kind, name_=self.name, autocomplete="off", **given, **start, **limits)

    def _draw_choices(self, here: Here) -> None:
        with tag("select", name_=self.name):
            if not self.required:
                tag("option", "", value="")
            for word, label in labelled(self.choices).items():
                chosen = {"selected": "true"} if word == self.start else {}
                tag("option", here.say(label), value=word, **chosen)


def _named(label: str) -> Tag:
    """A label around one control."""
    made = tag("label", classes="field")
    with made:
        tag("span", label)
    return made
