"""Words and options that a person types behind the name of a tool."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

BAD_INPUT = 2


def words(usage: str | None, *wanted: Any, typed: Sequence[str] | None = None) -> list[Any]:
    """The words, each of the type of its default; a type or a function of the word stands for no default.

    Other words are answered with `usage` and status 2.
    """
    said = sys.argv[1:] if typed is None else typed
    defaults = wanted[len(said) :]
    try:
        options = any(word.startswith("-") for word in said)
        if options or len(said) > len(wanted) or any(map(callable, defaults)):
            raise ValueError(said)
        return [*map(_read, said, wanted), *defaults]
    except (KeyError, ValueError):
        print(usage, file=sys.stderr)
        sys.exit(BAD_INPUT)


def _read(word: str, wanted: Any) -> Any:
    read = wanted if callable(wanted) else type(wanted)
    if read is int and not word.isdecimal():
        raise ValueError(word)
    return read(word)


def file(word: str) -> Path:
    """The whole path of a file that is there."""
    if not Path(word).is_file():
        raise ValueError(word)
    return Path(word).resolve()


def parser(usage: str | None, *, prog: str | None = None, seed: str = "") -> argparse.ArgumentParser:
    """A parser whose help begins with `usage` as it is; `seed` is what `--seed` draws, where it has that."""
    made = argparse.ArgumentParser(
        prog=prog, description=usage, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    if seed:
        made.add_argument("--seed", type=int, default=1, help=f"{seed} [1]")
    return made
