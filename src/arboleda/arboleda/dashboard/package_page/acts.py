"""Acts that somebody asks for on the page of a package: a button, or a form where there are fields."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import Any, TypeVar

from arboleda.model.errors import Refused
from arboleda.model.sentence import Phrase
from arboleda.web.access.auth import Role

from ..faces import Face
from ..page_api import PageApi
from ..tags import tag
from ..wording import Text
from .fields import Field
from .here import Here

Thing = TypeVar("Thing")
NO_PART = Phrase("page.no_part", "this plant runs no part {part}")


@dataclass(frozen=True, kw_only=True)
class Asked:
    """Request of somebody on the page, whose role is enough for it.

    `values` are by the names of the act's fields; of an act without fields they are what a script has sent.
    `of` is the row or the cell that it is about, "" for none.
    """

    values: Mapping[str, Any]
    of: str
    role: Role
    plant: PageApi

    def part(self, kind: type[Thing]) -> Thing:
        """The part of this class; a refusal where this plant runs none."""
        found = self.plant.ask(kind)
        if found is None:
            raise Refused(NO_PART(part=kind.__name__))
        return found


@dataclass(frozen=True)
class Act:
    """Act that the page offers as a button, or as a form where it has `fields`.

    `take` is called in a thread. The text that it returns is shown as the outcome, and an ArboledaError that
    it raises as the refusal. The page asks `asks` first: say one for whatever starts a robot. `role` is the
    least that may ask for it. `about` tells people more.
    """

    name: str
    label: Text
    take: Callable[[Asked], Text | None]
    _: KW_ONLY
    fields: Sequence[Field] = ()
    asks: Text = ""
    role: Role = Role.OPERATOR
    about: Text = ""

    def word(self, package: str) -> str:
        """The word by which it is asked for, also by scripts."""
        return f"{package}.{self.name}"

    def read(self, more: object) -> dict[str, Any]:
        """The values in what a page has sent; Refused says which one is wrong."""
        sent = more if isinstance(more, dict) else {}
        return {each.name: each.read(sent.get(each.name)) for each in self.fields} if self.fields else sent

    def draw(self, here: Here) -> None:
        label, takes = here.say(self.label), self.word(here.package)
        with tag("form", classes="act-form", aria_label=label, data_takes=takes, data_of=here.cell):
            with tag("div", classes="fields"):
                for each in self.fields:
                    each.draw(here)
                tag("button", label, type="submit", classes="act primary")
            if self.about:
                tag("p", here.say(self.about), classes="hint")
            tag("p", role="status", classes="outcome")

    def offer(self, here: Here, of: str) -> dict[str, Any]:
        """The button of it in a row."""
        label = here.say(self.label)
        return {"act": self.word(here.package), "of": of, "label": label, "does": here.say(self.about)}

    def face(self, here: Here) -> Face:
        return {}
