"""Hypothesis strategies for a plant: task texts that it takes, and faults that are possible in it."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import strategies as st

from arboleda.model.plant_model import Cell, PlantModel
from arboleda_proofs.simulator.faults import KINDS, Fault

WITHIN_S = 60.0
MS_PER_S = 1000


def tasks(model: PlantModel) -> st.SearchStrategy[str]:
    """Texts of tasks that the plant takes, without an id."""
    return st.one_of([each for cell in model.cells for each in (_storage(cell), _palletizing(cell))])


@st.composite
def faults(draw: st.DrawFn, model: PlantModel, *, within_s: float = WITHIN_S) -> Fault:
    """Faults as the simulator draws them, that begin within so many seconds of the start."""
    kind = draw(st.sampled_from([each for each in KINDS.values() if each.weight and each.targets(model)]))
    target = draw(_one_of(kind.targets(model)))
    return Fault(
        kind=kind.name,
        at=draw(_between(0.0, within_s)),
        seconds=draw(_between(*kind.seconds)),
        target=target,
        amount=draw(_between(*kind.amount)),
        word=draw(_one_of(kind.words(model, target))),
        seed=draw(st.integers(0, 2**32 - 1)),
    )


def _storage(cell: Cell) -> st.SearchStrategy[str]:
    paths = st.sampled_from([*cell.paths])
    stations = st.integers(0, len(cell.stations) - 1)
    return st.builds(lambda path, station: f"{cell.name} {path} {station}", paths, stations)


def _palletizing(cell: Cell) -> st.SearchStrategy[str]:
    names = st.sampled_from([cell.name, cell.roles["arm"].name])
    return names.map(lambda name: f"{name} palletizing")


def _one_of(names: Sequence[str]) -> st.SearchStrategy[str]:
    return st.sampled_from(list(dict.fromkeys(names)))


def _between(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers from the range, in thousandths, so that what hypothesis shows is short."""
    whole = st.integers(round(low * MS_PER_S), round(high * MS_PER_S))
    return whole.map(lambda thousandths: thousandths / MS_PER_S)
