"""Single faults that can befall a cell at an instant: of each kind that is simulated, in each form."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from arboleda.model.plant_model import Cell, PlantModel
from arboleda_proofs.simulator.faults import COUNTED, OF_CRASHES, OF_WORK, ON_ONE_HOST, Fault
from arboleda_proofs.simulator.faults.kind import NONE, Kind
from arboleda_proofs.simulator.recurring import Recurring

from .instants import Instant

OF_ITS_WORK, OF_ITS_BOARD, OF_OTHERS, OTHER_FORMS = range(4)  # numbers of parts


def single_faults(
    model: PlantModel,
    cell: Cell,
    instant: Instant,
    *,
    number: int = 0,
    only: Collection[str] = (),
    seen: Sequence[Recurring] = (),
) -> list[list[Fault]]:
    """The faults that begin at an instant, always in the same order, in parts.

    The first has one form of each kind in which the device whose step it is does its work badly, another one
    at the instant of the next `number`; the second the same of its board, its line and the people at it; the
    third of all other targets; the fourth has all other forms. Of each span both ends are taken, of each
    amount the largest. A kind that comes at a commit comes at each of those that follow the instant at once.
    `only`: of these kinds. Those that were `seen` of devices come before all.
    """
    kinds = [kind for kind in possible_kinds() if not only or kind.name in only]
    parts: list[list[Fault]] = [[] for _ in range(OTHER_FORMS + 1)]
    at_work, elsewhere = _at_work(cell, instant), _elsewhere(model, cell)
    for kind in kinds:
        for target in dict.fromkeys(kind.targets(model)):
            forms = [] if target in elsewhere else _forms(kind, model, target, instant)
            for index, form in enumerate(_from(number, forms)):
                part = _part(kind.name) if target in at_work else OF_OTHERS
                parts[OTHER_FORMS if index else part].append(form)
    parts[OF_ITS_WORK][:0] = _seen(model, cell, instant, [each for each in seen if each.kind in kinds])
    return parts


def _seen(model: PlantModel, cell: Cell, instant: Instant, seen: Sequence[Recurring]) -> Iterator[Fault]:
    """The faults that were seen, as hard as they were, of the devices of this cell."""
    faults = (fault for each in seen for fault in each.hardest(model, instant.at))
    elsewhere = _elsewhere(model, cell)
    return (fault for fault in faults if fault.target not in elsewhere)


def _part(kind: str) -> int:
    """The part of a kind of fault of the device whose step it is."""
    return OF_ITS_WORK if kind in OF_WORK else OF_ITS_BOARD


def possible_kinds() -> list[Kind]:
    """The kinds that are tried: all of a plant on one host that seeds may draw."""
    return [kind for kind in ON_ONE_HOST.values() if kind.weight or kind.name in OF_CRASHES]


def _forms(kind: Kind, model: PlantModel, target: str, instant: Instant) -> list[Fault]:
    return [
        Fault(kind=kind.name, at=instant.at, seconds=seconds, target=target, amount=amount, word=word)
        for word in dict.fromkeys(kind.words(model, target))
        for seconds in sorted(set(kind.seconds), reverse=True)
        for amount in _amounts(kind, instant)
    ]


def _from(number: int, forms: list[Fault]) -> list[Fault]:
    """The forms, beginning with the one of this number in turn."""
    first = number % max(len(forms), 1)
    return forms[first:] + forms[:first]


def _amounts(kind: Kind, instant: Instant) -> list[float]:
    if kind.name in COUNTED:
        return [float(number) for number in range(1, instant.commits + 1)]
    return [0.0 if kind.amount == NONE else kind.amount[1]]


def _at_work(cell: Cell, instant: Instant) -> frozenset[str]:
    """The names of the device whose step has begun last."""
    name = instant.what.partition(":")[0]
    return frozenset(each for robot in cell.robots if robot.name == name for each in (name, robot.mqtt))


def _elsewhere(model: PlantModel, cell: Cell) -> set[str]:
    """Names of all that belongs to other cells alone, where nothing can matter to the cell at work."""
    others = [each for each in model.cells if each is not cell]
    theirs = {name for other in others for robot in other.robots for name in (robot.name, robot.mqtt)}
    ours = {name for robot in cell.robots for name in (robot.name, robot.mqtt)}
    return {other.name for other in others} | (theirs - ours)
