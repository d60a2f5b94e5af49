"""Numbers, faults and ends of tasks, written for a person."""

from __future__ import annotations

from collections.abc import Collection

from arboleda.model.counting import counted
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.faults.titles import FORMS, title


def seeds(done: Collection[int]) -> str:
    """`20 seeds (1 to 20)`."""
    which = f" ({min(done)} to {max(done)})" if len(done) > 1 else ""
    return counted(len(done), "seed") + which


def short(number: int) -> str:
    """A large number for a narrow place: `812`, `34.2 k`, `5.61 M`."""
    for unit, size in (("G", 10**9), ("M", 10**6), ("k", 10**3)):
        if number >= size:
            return f"{number / size:.3g} {unit}"
    return str(number)


def fault_said(fault: Fault) -> str:
    """The fault by its name for people: whom it befalls, how, and for how long; without its time."""
    forms = (
        "" if (fault.kind, fault.word) in FORMS else fault.word,
        f"{fault.amount:g}" if fault.amount else "",
    )
    how = ", ".join(filter(None, forms))
    lasting = f", for {fault.seconds:.3f} s" if fault.seconds else ""
    return f"{fault.target}: {title(fault.kind, fault.word)}{f' ({how})' if how else ''}{lasting}"
