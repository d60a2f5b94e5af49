"""Templates of another language: texts that were made in English, said by the templates they were made of."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from string import Formatter

from . import FIRST, contents

WORDS = r"[^\s,;]+(?:, [^\s,;]+)*"  # what a template of one small word may stand between
ANYTHING = r".*?"
FEW = 6  # letters of a template that stands between words only
LETTER = re.compile(r"[^\W\d_]")
BEFORE, AFTER = "before", "after"  # what a template follows, and what follows it
LONGEST = 2000  # characters of a line that is looked at
DEEPEST = 12  # texts in texts
MOST_KNOWN = 5000  # texts that are kept
JOINTS = (": ", "; ", " ")
SUBJECT = re.compile(r"[\w.-]+")  # a name, as before "has ..."
QUOTES = ('"', "'", "`")

Part = Callable[[str, str], str]


class Template:
    """An English text with {slots}, and the same text in another language.

    One that begins with a blank, a comma or a semicolon may stand behind another text; one that ends with a
    blank, before another.
    """

    def __init__(self, english: str, other: str) -> None:
        behind, ahead = english[:1] in (" ", ",", ";"), english[-1:] == " "
        self._english, self._other = (
            [*([("", BEFORE)] if behind else []), *_pieces(text), *([("", AFTER)] if ahead else [])]
            for text in (english, other)
        )
        self._literals = [text for text, _ in self._english if text]
        self.letters = sum(len(LETTER.findall(text)) for text in self._literals)

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        punctuated = any(sign in text for text in self._literals for sign in ",;:()")
        slot = WORDS if 0 < self.letters < FEW and not punctuated else ANYTHING
        found, named = "", set[str]()
        for text, name in self._english:
            again = f"(?P=_{name})" if name in named else f"(?P<_{name}>{slot})"
            found += f"{re.escape(text)}{again if name else ''}"
            named.add(name)
        return re.compile(found)

    def slots(self, text: str) -> dict[str, str] | None:
        """The words in the slots of a text of this template; None: it is of another."""
        if not all(each in text for each in self._literals):
            return None
        found = self._pattern.fullmatch(text)
        return None if found is None else {slot: found[f"_{slot}"] for _, slot in self._english if slot}

    def verbatim(self, slot: str) -> bool:
        """True if a slot stands in quotes, in which nothing is said in another language."""
        return any(words[-1:] in QUOTES and slot == name for words, name in self._english if words)

    def fill(self, parts: Mapping[str, str]) -> str:
        """The text in the other language, with these in its slots."""
        return "".join(f"{words}{parts[slot] if slot else ''}" for words, slot in self._other)


class Templates:
    """Templates of a language, by their English. A text is said by those that have most of its letters, the
    ones for the texts in its slots included. `part` says these in another way.
    """

    def __init__(self, rows: Mapping[str, str], part: Part | None = None) -> None:
        self._made = [Template(english, other) for english, other in rows.items()]
        self._part = part
        self._known: dict[str, tuple[int, str]] = {}

    def __call__(self, text: str) -> str:
        """The text in the language, line by line, as far as it is made of these templates."""
        if not self._made:
            return text
        if len(self._known) > MOST_KNOWN:
            self._known.clear()
        return "\n".join(self._best(each)[1] if len(each) <= LONGEST else each for each in text.split("\n"))

    def _best(self, text: str, depth: int = 0) -> tuple[int, str]:
        """The number of letters of a text that are of templates, and the text in the language."""
        if depth > DEEPEST or not LETTER.search(text):
            return 0, text
        if text not in self._known:
            ways = (*self._joined(text, depth), *self._fitting(text, depth), (0, text))
            self._known[text] = max(ways, key=lambda each: each[0])
        return self._known[text]

    def _fitting(self, text: str, depth: int) -> Iterator[tuple[int, str]]:
        """The text by each template that fits."""
        for each in self._made:
            slots = each.slots(text)
            if slots is None:
                continue
            if self._part is not None:
                parts = {slot: self._part(slot, value) for slot, value in slots.items()}
                yield each.letters, each.fill(parts)
                continue
            found = {
                slot: (0, value) if each.verbatim(slot) else self._best(value, depth + 1)
                for slot, value in slots.items()
            }
            letters = each.letters + sum(letters for letters, _ in found.values())
            yield letters, each.fill({slot: words for slot, (_, words) in found.items()})

    def _joined(self, text: str, depth: int) -> Iterator[tuple[int, str]]:
        """The text as two that stand beside each other: behind a place, a subject, or a sentence.

        What is in the slots is the business of `part` where there is one, so nothing is looked for there.
        """
        if self._part is not None:
            return
        for sign in JOINTS:
            first, between, rest = text.partition(sign)
            if not between or (sign == " " and not SUBJECT.fullmatch(first)):
                continue
            one, other = (
                (0, first) if sign == " " else self._best(first, depth + 1),
                self._best(rest, depth + 1),
            )
            yield one[0] + other[0], f"{one[1]}{between}{other[1]}"


def heading(language: str, text: str) -> str:
    """The heading of a column of what is found."""
    if language == FIRST:
        return text
    return str(contents(language, "findings").get("headings", {}).get(text, text))


def _pieces(text: str) -> list[tuple[str, str]]:
    """Each literal of a template with the slot that follows it, if one does."""
    return [(words, slot or "") for words, slot, *_ in Formatter().parse(text)]
