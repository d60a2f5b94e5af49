"""Weathers in which the simulator alone looks for bugs of the engine: plants and faults by the seed.

Two of three seeds run on cells of devices that they draw, each with a theme of its own, as many of them with
trees as XML as with recipes in Python; the others on the packaged plants, the examples, and cells of storage
that they draw. Six of 15 are without faults: only then a drawn recipe itself says what its tasks must do.
Imports what may have a bug.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path

from arboleda.plant_file import loader
from arboleda_drawn.devices import Form
from arboleda_drawn.plants import of_storage
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.campaigns.setting import Setting

from .themes import plants_of

CYCLES = 20  # of a seed; then everything has to come to rest
NONE, MANY, CRASHES = "none", "many", "crashes"
EXAMPLES = Path(__file__).parents[3] / "examples"


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """Plants of one sort, a plant of its own for each seed."""

    of: Callable[[int], Plant]


@dataclass(frozen=True, kw_only=True)
class Turns:
    """Plants of which each of its seeds takes the next one."""

    load: tuple[Callable[[], Plant], ...]

    def of(self, seed: int) -> Plant:
        return self.load[seed // len(WEATHERS) % len(self.load)]()


@dataclass(frozen=True, kw_only=True)
class Weather:
    """Weather of a seed; without faults a task that fails is a finding, too."""

    plants: Drawn | Turns
    level: str = MANY
    options: dict[str, bool] = field(default_factory=dict)

    def found(self, seed: int) -> str:
        """The finding at a seed, "" for none: the invariant that breaks, or the sort of a finding."""
        setting = Setting(plants=self.plants, cycles=CYCLES, level=self.level, **self.options)
        result = setting.run(seed)
        if result.broken is not None:
            return result.broken.invariant
        finding = next(iter(result.findings), None) if self.level == NONE else None
        return finding.kind.value if finding is not None else ""


@cache
def _example(name: str) -> Plant:
    return Plant(declared=loader.load(EXAMPLES / name / "plant.yaml"))


@cache
def _packaged(name: str) -> Plant:
    with as_file(files("arboleda").joinpath(f"plants/{name}.yaml")) as path:
        return Plant(declared=loader.load(path) if name == "shared" else loader.load())


def example(name: str) -> Callable[[], Plant]:
    return lambda: _example(name)


def packaged(name: str) -> Callable[[], Plant]:
    return lambda: _packaged(name)


DEVICES, TREES = (Drawn(of=plants_of(form)) for form in (Form.PYTHON, Form.XML))
STORAGE = Drawn(of=of_storage)
CELLS = Turns(load=tuple(map(example, ("own_tree", "machine_tending", "lab_bench"))))
PACKAGED = Turns(load=(packaged("shared"), packaged("plant")))
WEATHERS = (
    Weather(plants=TREES, level=NONE),
    Weather(plants=CELLS),
    Weather(plants=DEVICES, level=NONE),
    Weather(plants=PACKAGED),
    Weather(plants=TREES, level=NONE),
    Weather(plants=STORAGE, options={"any_of": True}),
    Weather(plants=DEVICES),
    Weather(plants=TREES, level=CRASHES),
    Weather(plants=DEVICES, level=NONE),
    Weather(plants=TREES),
    Weather(plants=DEVICES, level=NONE, options={"any_of": True}),
    Weather(plants=PACKAGED, level=CRASHES, options={"any_of": True}),
    Weather(plants=DEVICES, level=CRASHES),
    Weather(plants=TREES, level=NONE),
    Weather(plants=PACKAGED, options={"standby": True}),
)


def forget() -> None:
    """Have the next seed load its plant anew."""
    _example.cache_clear()
    _packaged.cache_clear()


def found_at(seed: int) -> str:
    """The finding at a seed, "" for none."""
    return WEATHERS[seed % len(WEATHERS)].found(seed)
