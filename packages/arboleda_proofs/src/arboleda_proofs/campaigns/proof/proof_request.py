"""Request of a person to `arboleda prove`, checked as a whole before anything runs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from arboleda.extension import ConfigError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file import loader
from arboleda_proofs.simulator.checks import BadFaults
from arboleda_proofs.simulator.recurring import UNLIKE, Recurring, recurring_from

from ..faults_file import line_of, read
from ..plants import Plant
from .single_faults import possible_kinds


@dataclass(frozen=True, kw_only=True)
class ProofRequest:
    """Request: the options. `budget_s`: how long runs begin, infinite for all; `anew`: nothing kept in
    `folder` counts; `pairs`: what is left of the time is for two faults in one run; `mend`: a change of the
    files is looked for that mends what is found; `every`: at every instant, not at one of each class.
    `faults` is a file of faults that devices had.
    """

    plant: Path | None
    recipes: tuple[str, ...]
    kinds: tuple[str, ...]
    budget_s: float
    folder: Path
    anew: bool = False
    pairs: bool = False
    mend: bool = False
    every: bool = False
    faults: Path | None = None
    json: Path | None = None
    html: Path | None = None
    junit: Path | None = None
    tests: Path | None = None
    badge: Path | None = None

    @cached_property
    def _loaded(self) -> tuple[Plant, PlantFiles]:
        model, read = loader.load_with_files(self.plant)
        return Plant(declared=model, files=read), read

    @cached_property
    def seen(self) -> tuple[Recurring, ...]:
        """The faults that devices had; ConfigError if the file has others, or the plant cannot have them."""
        if self.faults is None:
            return ()
        content, model = read(self.faults, None).climate, self._loaded[0].model
        if not isinstance(content, dict) or content.keys() != {UNLIKE}:
            raise ConfigError(
                (
                    f"{self.faults} is no file that `arboleda record unlike --to` wrote: it has {UNLIKE},"
                    " and nothing else",
                )
            )
        try:
            return recurring_from(model, content[UNLIKE])
        except BadFaults as error:
            where = line_of(self.faults, error.place)
            raise ConfigError((f"{self.faults}: {where}{error} (plant {model.name})",)) from None

    @property
    def simulated(self) -> Plant:
        """The plant; ConfigError if it cannot be read, has no such recipe, or there is no such fault."""
        there = dict.fromkeys(each.name for cell in self._loaded[0].model.cells for each in cell.recipes)
        for name in self.recipes:
            if name not in there:
                known = ", ".join(there)
                raise ConfigError((f"--recipe: {name!r} is no recipe of this plant; there are {known}",))
        possible = [kind.name for kind in possible_kinds()]
        for name in self.kinds:
            if name not in possible:
                sentence = f"--fault: {name!r} is no kind of fault; there are {', '.join(possible)}"
                raise ConfigError((sentence,))
        return self._loaded[0]

    @property
    def files(self) -> PlantFiles:
        """The files that the plant was read from."""
        return self._loaded[1]
