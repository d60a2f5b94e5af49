"""Switches for the faults of a virtual controller; they are set from any thread while it runs."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping


class Faults(Collection[str]):
    """Faults that are on; `known` has a sentence for each that there is."""

    def __init__(self, known: Mapping[str, str], on: Iterable[str] = ()) -> None:
        self.known = dict(known)
        self._on: frozenset[str] = frozenset()
        for name in on:
            self.switch(name, on=True)

    def switch(self, name: str, *, on: bool) -> None:
        """Switch a fault on or off; raises ValueError, which lists all, for an unknown one."""
        if name not in self.known:
            raise ValueError(f"no fault {name!r}; there are {', '.join(self.known)}")
        self._on = self._on | {name} if on else self._on - {name}

    def __contains__(self, name: object) -> bool:
        return name in self._on

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self._on))

    def __len__(self) -> int:
        return len(self._on)
