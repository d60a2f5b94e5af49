"""Templates of another language: texts that were made in English, said by the templates they were made of."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice
from string import Formatter

from . import FIRST, contents

WORDS = r"[^\s,;]+(?:, [^\s,;]+)*"  # what a template of one small word may stand between
ANYTHING = r".*?"
FEW = 6  # letters of a template that stands between words only
ADDRESS, BRIEF = r"\S*[\d./:]\S*", 16  # of a device; letters of a text that may be a user's own without one
LETTER = re.compile(r"[^\W\d_]")
BEFORE, AFTER = "before", "after"  # what a template follows, and what follows it
END = "end"  # begins the names of slots for an end of a task or for its cause, by the plant's own word
INDENT = "  "  # before a line that stands by itself
LONGEST = 2000  # characters of a line that is looked at
DEEPEST = 12  # texts in texts
MOST_KNOWN = 5000  # texts that are kept
PLACE_JOINT = ": "  # behind a place
SENTENCE_JOINT, SUBJECT_JOINT = "; ", " "  # behind a sentence, and behind a subject
MOST_SENTENCES = 12  # of a text that is taken apart at each of its joints; of more, at the first
SUBJECT = re.compile(r"[\w.-]+")  # a name, as before "has ..."
QUOTES = ('"', "'", "`")
SLOT = "\0"  # for one, where its name is of no interest

Part = Callable[[str, str], str]


class Template:
    """An English text with {slots}, and the same text in another language.

    One that begins with one blank, a comma or a semicolon may stand behind another text; one that ends with a
    blank, before another.
    """

    def __init__(self, english: str, other: str, *, of_devices: bool = False) -> None:
        is_line = english.startswith(INDENT)
        behind, ahead = not is_line and english[:1] in (" ", ",", ";"), english[-1:] == " "
        self._english, self._other = (
            [*([("", BEFORE)] if behind else []), *_pieces(text), *([("", AFTER)] if ahead else [])]
            for text in (english, other)
        )
        self._literals = [text for text, _ in self._english if text]
        self.letters = sum(len(LETTER.findall(text)) for text in self._literals)
        self._punctuated = is_line or any(sign in text for text in self._literals for sign in ",;:()")
        is_brief = self.letters < BRIEF and not self._punctuated
        self._begins_with_address = of_devices and is_brief and english.startswith("{0} ")
        self.words = _whole_words(self._english)  # between blanks, in every text of this template

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        slot = WORDS if 0 < self.letters < FEW and not self._punctuated else ANYTHING
        found, named = "", set[str]()
        for text, name in self._english:
            held = ADDRESS if self._begins_with_address and not named else slot
            again = f"(?P=_{name})" if name in named else f"(?P<_{name}>{held})"
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


@dataclass(frozen=True, kw_only=True)
class Translation:
    """A text in the other language, with the letters of its English that templates account for, and how many
    templates that took."""

    text: str
    letters: int = 0
    templates: int = 0


class Templates:
    """Templates of a language, by their English. A text is said by those that have most of its letters, the
    ones for the texts in its slots included; where that is as many, by the fewest. `part` says texts in slots
    in another way. `ends` has the words for ends of tasks: in other slots they may be names of a plant.
    Of rows `of_devices` a brief one that begins with a slot has an address there, so that a sentence of a
    user's own that ends alike is left as it is.
    """

    def __init__(
        self,
        rows: Mapping[str, str],
        part: Part | None = None,
        ends: Mapping[str, str] | None = None,
        *,
        of_devices: Container[str] = (),
    ) -> None:
        self._made = [
            Template(english, other, of_devices=english in of_devices) for english, other in rows.items()
        ]
        self._of_word, self._of_any = _by_rarest_word(self._made)
        self._part = part
        self._ends = ends or {}
        self._known: dict[str, Translation] = {}

    def __call__(self, text: str) -> str:
        """The text in the language, line by line, as far as it is made of these templates."""
        if not self._made:
            return text
        if len(self._known) > MOST_KNOWN:
            self._known.clear()
        return "\n".join(self._best(each).text if len(each) <= LONGEST else each for each in text.split("\n"))

    def _best(self, text: str, depth: int = 0) -> Translation:
        """The best translation of a text, itself if nothing in it is of a template."""
        if depth > DEEPEST or not LETTER.search(text):
            return Translation(text=text)
        if text not in self._known:
            ways = (
                *self._joined(text, depth, PLACE_JOINT),
                *self._fitting(text, depth),
                *self._indented(text, depth),
                *self._joined(text, depth, SENTENCE_JOINT),
                *self._joined(text, depth, SUBJECT_JOINT),
                Translation(text=text),
            )
            self._known[text] = max(ways, key=lambda each: (each.letters, -each.templates))
        return self._known[text]

    def _fitting(self, text: str, depth: int) -> Iterator[Translation]:
        """The text by each template that fits."""
        words = {*text.split(" ")} & self._of_word.keys()
        for number in sorted([*self._of_any, *(each for word in words for each in self._of_word[word])]):
            each = self._made[number]
            slots = each.slots(text)
            if slots is None:
                continue
            if self._part is not None:
                parts = {slot: self._part(slot, value) for slot, value in slots.items()}
                yield Translation(text=each.fill(parts), letters=each.letters, templates=1)
                continue
            found = {slot: self._in_slot(each, slot, value, depth) for slot, value in slots.items()}
            yield Translation(
                text=each.fill({slot: value.text for slot, value in found.items()}),
                letters=each.letters + sum(value.letters for value in found.values()),
                templates=1 + sum(value.templates for value in found.values()),
            )

    def _in_slot(self, template: Template, slot: str, value: str, depth: int) -> Translation:
        """The text in a slot of a template."""
        if slot.startswith(END) and value in self._ends:
            return Translation(text=self._ends[value], letters=len(LETTER.findall(value)))
        return Translation(text=value) if template.verbatim(slot) else self._best(value, depth + 1)

    def _indented(self, text: str, depth: int) -> Iterator[Translation]:
        """The text behind the blanks that it begins with."""
        rest = text.lstrip(" ")
        if self._part is None and rest != text:
            found = self._best(rest, depth + 1)
            yield replace(found, text=f"{text[: -len(rest)]}{found.text}")

    def _joined(self, text: str, depth: int, joint: str) -> Iterator[Translation]:
        """The text as two that stand beside each other, with the first joint between them, or with any that
        ends a sentence, as a sentence may have another in it.

        What is in the slots is the business of `part` where there is one, so nothing is looked for there.
        """
        if self._part is not None:
            return
        pieces = text.split(joint)
        tries_all = joint == SENTENCE_JOINT and len(pieces) <= MOST_SENTENCES
        ends = (end for end in range(1, len(pieces)) if _is_outside_braces(joint.join(pieces[:end])))
        for end in ends if tries_all else islice(ends, 1):
            first, rest = joint.join(pieces[:end]), joint.join(pieces[end:])
            if joint == SUBJECT_JOINT and not SUBJECT.fullmatch(first):
                return
            one = Translation(text=first) if joint == SUBJECT_JOINT else self._best(first, depth + 1)
            other = self._best(rest, depth + 1)
            yield Translation(
                text=f"{one.text}{joint}{other.text}",
                letters=one.letters + other.letters,
                templates=one.templates + other.templates,
            )


def heading(language: str, text: str) -> str:
    """The heading of a column of what is found."""
    if language == FIRST:
        return text
    return str(contents(language, "findings").get("headings", {}).get(text, text))


def _pieces(text: str) -> list[tuple[str, str]]:
    """Each literal of a template with the slot that follows it, if one does."""
    return [(words, slot or "") for words, slot, *_ in Formatter().parse(text)]


def _is_outside_braces(text: str) -> bool:
    """True if all braces of the text are closed: what stands in braces is one thing."""
    return text.count("{") <= text.count("}")


def _whole_words(pieces: Sequence[tuple[str, str]]) -> set[str]:
    """The words of the literals that no slot goes on with."""
    whole = "".join(f"{text}{SLOT if slot else ''}" for text, slot in pieces)
    return {word for word in whole.split(" ") if word and SLOT not in word}


def _by_rarest_word(made: Sequence[Template]) -> tuple[Mapping[str, list[int]], list[int]]:
    """The numbers of templates by one word of each that few others have; those of templates without any."""
    many = Counter(word for each in made for word in each.words)
    of_word, of_any = defaultdict[str, list[int]](list), list[int]()
    for number, each in enumerate(made):
        rows = of_word[min(sorted(each.words), key=many.__getitem__)] if each.words else of_any
        rows.append(number)
    return of_word, of_any
