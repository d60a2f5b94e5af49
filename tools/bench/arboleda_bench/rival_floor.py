"""Floor of `rival`: says the next step of a list for each line."""

from __future__ import annotations

import sys
from collections.abc import Iterator

from .rival_lines import begin, end, recipe


def main() -> None:
    kinds = recipe()
    left: Iterator[str] = iter(())
    for line in sys.stdin:
        left = iter(kinds) if line == "task\n" else left
        kind = next(left, None)
        if kind is None:
            end()
        else:
            begin(kind)


if __name__ == "__main__":
    main()
