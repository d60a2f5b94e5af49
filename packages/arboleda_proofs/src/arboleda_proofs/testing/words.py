"""Words of a test, checked against those that exist."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from arboleda.extension import ArboledaError

__tracebackhide__ = True


class Plain(Exception):
    """Error that a notebook shows as its sentence: Jupyter asks an exception for its lines."""

    def _render_traceback_(self) -> list[str]:
        return [str(self)]


class Misuse(Plain, ArboledaError):
    """Raised when a test asks for something that does not exist; the sentence says what exists."""


def known(what: str, word: str, names: Iterable[str]) -> str:
    """The known name that `word` is, whatever its case; raises Misuse with all names if there is none."""
    names = list(names)
    spelt = {name.lower(): name for name in names}
    if isinstance(word, str) and word.lower() in spelt:
        return spelt[word.lower()]
    near = get_close_matches(str(word).lower(), spelt, n=1)
    hint = f"; did you mean {spelt[near[0]]!r}?" if near else ""
    raise Misuse(f"{word!r} is not {what}; there are {', '.join(names) or 'none'}{hint}")
