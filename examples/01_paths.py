"""Lesson 1: a table of paths, how to look one up, and why a table that can change is a trap."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from types import MappingProxyType

from arboleda_class.lessons import spoken

COLUMNS = ROWS = 3  # nodes are numbered row by row: 0 1 2 / 3 4 5 / 6 7 8

Nodes = tuple[int, ...]
WAYS: Mapping[str, Nodes] = MappingProxyType(  # start node 0, 1 or 2; exit A = 6, B = 7, C = 8
    {
        "0A": (0, 3, 6),
        "0B": (0, 3, 4, 7),
        "0C": (0, 3, 4, 5, 8),
        "1A": (1, 4, 3, 6),
        "1B": (1, 4, 7),
        "1C": (1, 4, 5, 8),
        "2A": (2, 5, 4, 3, 6),
        "2B": (2, 5, 4, 7),
        "2C": (2, 5, 8),
    }
)
GRIDS = MappingProxyType({"malla_A": WAYS, "malla_B": WAYS, "malla_C": WAYS})


class PathError(LookupError):
    """One sentence: which word means nothing, and which would."""


def find(grid: str, code: str) -> Nodes:
    """The nodes of a path; spaces and case are forgiven, anything else is a PathError."""
    ways = GRIDS[known("grid", grid, GRIDS)]
    return ways[known("code", code, ways)]


def known(kind: str, word: str, names: Iterable[str]) -> str:
    """The name that `word` spells."""
    wanted = "".join(word.split()).lower()
    for name in names:
        if name.lower() == wanted:
            return name
    raise PathError(f"there is no {kind} {word!r}; there are {', '.join(names)}")


def first_jump(nodes: Sequence[int]) -> tuple[int, int] | None:
    """The first two nodes in a row that are no neighbours on the grid; None where every step is one."""
    for here, there in pairwise(nodes):
        (row, column), (next_row, next_column) = divmod(here, COLUMNS), divmod(there, COLUMNS)
        if abs(row - next_row) + abs(column - next_column) != 1:
            return here, there
    return None


def show_table() -> None:
    print("The paths of malla_A, malla_B and malla_C:")
    for code, nodes in WAYS.items():
        print(f"  {code}  {' -> '.join(map(str, nodes))}")


def show_look_ups() -> None:
    print("\nLooking paths up:")
    for grid, code in [("malla_A", "0B"), (" MALLA_b", "2 c "), ("malla_D", "0B"), ("malla_A", "3A")]:
        try:
            print(f"  find({grid!r}, {code!r}) = {find(grid, code)}")
        except PathError as error:
            print(f"  find({grid!r}, {code!r}): {error}")


def show_trap() -> None:
    print("\nThe trap: two names for one table of lists.")
    malla_a = {"0B": [0, 3, 4, 7]}
    malla_b = malla_a  # not a copy, a second name
    malla_b["0B"].append(2)
    print(f"  malla_b was changed, and malla_a['0B'] is now {malla_a['0B']}")
    copy = dict(malla_a)  # a new dict, but the same lists in it
    copy["0B"].append(8)
    print(f"  a copy was changed, and malla_a['0B'] is now {malla_a['0B']}")
    print(
        f"  the first jump in it is {first_jump(malla_a['0B'])}; in WAYS['0B'] it is {first_jump(WAYS['0B'])}"
    )


def show_frozen() -> None:
    print("\nA frozen table: tuples behind a read-only view.")
    try:
        WAYS["0B"] = (0, 1)  # type: ignore[index]
    except TypeError as error:
        print(f"  WAYS['0B'] = ...: {error}")
    try:
        WAYS["0B"].append(8)  # type: ignore[attr-defined]
    except AttributeError as error:
        print(f"  WAYS['0B'].append(8): {error}")


def main() -> None:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("--grid", help="look this grid's path up, e.g. malla_A")
    parser.add_argument("--code", help="and this code, e.g. 0B")
    wanted = parser.parse_args()
    if wanted.grid is None and wanted.code is None:
        for show in (show_table, show_look_ups, show_trap, show_frozen):
            show()
        return
    try:
        print(*find(wanted.grid or "", wanted.code or ""))
    except PathError as error:
        raise SystemExit(str(error)) from None


if __name__ == "__main__":
    spoken(main)
