"""Text from outside, made fit for log, terminal, page and sentences.

A task, the name of a ROS node or a plant file may have any letters: escape sequences that a terminal obeys,
line ends that forge a line of the log, marks that turn the writing direction around, or a hundred thousand
letters. Such text is only shown by the functions here.
"""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

LINE = 200  # characters; a sentence with more is not read


def plain(text: str, most: int = LINE) -> str:
    """One line of at most `most` characters (4 or more), all of them printable; others are escaped.

    Short text of printable characters stays as it is, in every language.
    """
    # What str.isprintable() refuses are controls, line ends, marks of writing direction, characters without
    # width, surrogates and what Unicode does not assign.
    near = text[: most + 1]
    line = near if near.isprintable() else "".join(map(_escaped, near))
    return line if len(line) <= most else line[: most - 3] + "..."


def quoted(value: object, most: int = 40) -> str:
    """A foreign value as a sentence names it: printable, text in quotes and clipped to `most` characters.

    >>> quoted("sis_z"), quoted("sí"), quoted(b"\\x1b[2J"), quoted(7)
    ("'sis_z'", "'sí'", "b'\\\\x1b[2J'", '7')
    """
    if isinstance(value, str):
        return repr(value if len(value) <= most else value[: most - 3] + "...")
    if isinstance(value, bytes):
        return repr(value if len(value) <= most else value[: most - 3] + b"...")
    return plain(repr(value), most)


def text_of_error(error: BaseException, most: int = LINE) -> str:
    """The text of an error, on one line; its name where it has none.

    >>> text_of_error(ValueError("no port")), text_of_error(TimeoutError())
    ('no port', 'TimeoutError')
    """
    return plain(str(error).strip(), most) or type(error).__name__


def among(word: str, allowed: Iterable[str]) -> str:
    """The words that are allowed instead of a wrong one, and the nearest of them.

    >>> among("opne", ["open", "close"]), among("opne", [])
    ('there are open, close; did you mean open?', 'there are none')
    """
    there = list(allowed)
    near = get_close_matches(word.lower(), there, n=1)
    hint = f"; did you mean {near[0]}?" if near else ""
    return f"there are {', '.join(there) or 'none'}{hint}"


def _escaped(letter: str) -> str:
    return letter if letter.isprintable() else letter.encode("unicode_escape").decode("ascii")
