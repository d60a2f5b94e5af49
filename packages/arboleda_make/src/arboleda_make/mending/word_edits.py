"""Candidates in a line of a file: a word or a number that is not allowed, and those that are."""

from __future__ import annotations

import re
from collections.abc import Iterator

from arboleda.drivers import plain
from arboleda.plant_check.findings import Source
from arboleda.plant_check.mend import Cut, Texts

from .candidate import Candidate
from .clues import NUMBER, WORD, Clues

ALLOWED = re.compile(r"(?:there are|its answers:|facts:|known:|takes|must be|has only) ([^;\n]*)")
AT_LEAST = "at least"
MOST = 12  # words that are tried for one


def word_candidates(texts: Texts, clues: Clues) -> Iterator[Candidate]:
    """The candidates at the line of a problem; where the word is not there, anywhere in its file."""
    found = clues.first
    if found.file in texts and found.source is Source.PROBLEM:
        yield from _words(texts, clues, found.file)
        yield from _numbers(texts, clues, found.file)


def _words(texts: Texts, clues: Clues, file: str) -> Iterator[Candidate]:
    allowed = [*clues.meant, *_allowed(clues)]
    for wrong in clues.quoted:
        for rank, right in enumerate(dict.fromkeys(allowed)):
            if right != wrong and rank < MOST:
                yield from _replaced(texts, clues, file, re.escape(wrong), right, 8 - rank / 10)


def _allowed(clues: Clues) -> Iterator[str]:
    for listed in ALLOWED.findall(clues.first.sentence):
        yield from (each for each in WORD.findall(listed) if each not in ("and", "or", "a", "is"))


def _numbers(texts: Texts, clues: Clues, file: str) -> Iterator[Candidate]:
    """The nearest number that is allowed; above a lower limit twice as much, to have some room."""
    sentence = clues.first.sentence
    numbers = [float(each.replace(",", "")) for each in NUMBER.findall(sentence)]
    for wrong in numbers:
        others = sorted({each for each in numbers if each != wrong}, key=lambda each: abs(each - wrong))
        more = [2 * each for each in others] if AT_LEAST in sentence else []
        for rank, right in enumerate([*more, *others]):
            yield from _replaced(texts, clues, file, re.escape(f"{wrong:g}"), f"{right:g}", 4 - rank / 10)


def _replaced(
    texts: Texts, clues: Clues, file: str, wrong: str, right: str, score: float
) -> Iterator[Candidate]:
    """The word in the line of the finding; where it is not there, anywhere in the file."""
    text, line = texts[file], clues.first.line
    found = [each.span() for each in re.finditer(rf"(?<![\w.]){wrong}(?![\w])", text)]
    found = found or [each.span() for each in re.finditer(rf"(?<![\w]){wrong}(?![\w])", text)]
    here = [span for span in found if text.count("\n", 0, span[0]) + 1 == line]
    for start, end in here or found:
        yield Candidate(
            cuts=(Cut(file=file, start=start, end=end, new=right),),
            sentence=f"{plain(right)} in place of {plain(text[start:end])}",
            score=score if here else score - 1,
        )
