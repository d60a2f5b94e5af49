"""The words a test uses, checked against what there is."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from arboleda.model.errors import ArboledaError

__tracebackhide__ = True


class Misuse(ArboledaError):
    """A test asks for what there is not; the sentence says what there is."""


def known(what: str, word: str, names: Iterable[str]) -> str:
    """The name that `word` is, whatever its case; Misuse with all of them where there is none."""
    names = list(names)
    spelt = {name.lower(): name for name in names}
    if isinstance(word, str) and word.lower() in spelt:
        return spelt[word.lower()]
    near = get_close_matches(str(word).lower(), spelt, n=1)
    hint = f"; did you mean {spelt[near[0]]!r}?" if near else ""
    raise Misuse(f"{word!r} is not {what}; there are {', '.join(names) or 'none'}{hint}")
