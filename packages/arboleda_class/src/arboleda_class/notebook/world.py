"""World for a notebook: a plant that is stepped by hand, and what a notebook shows of it in place."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from pathlib import Path
from traceback import format_exception

from arboleda.extension import words
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import examples
from arboleda.web.languages import FIRST, LANGUAGES, texts
from arboleda_proofs.campaigns.from_above import FloorPlan
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_proofs.testing.sim import Sim
from arboleda_proofs.testing.words import Plain, known

from .drawn import Drawing, Table
from .logbook import Logbook

STEP_AT_MOST_S = 60.0


class Failed(Plain, AssertionError):
    """Raised where the simulation is wrong: an AssertionError of `Sim` as a notebook shows it."""

    def _render_traceback_(self) -> list[str]:
        cause = self.__cause__  # what the simulation raised: its place is what one needs
        return [*super()._render_traceback_(), *(format_exception(cause) if cause else ())]


class World(Sim):
    """One plant in a notebook: `Sim`, whose tree, twin and time line are drawn in place.

    `plant` is a file, the name of an example (`arboleda examples` lists them) or a model; None is the shipped
    plant. What a cell of the notebook ends with is shown: the world itself, `tree`, `twin`, `table`, `step`.
    """

    _failure = Failed

    def __init__(
        self,
        plant: PlantModel | Path | str | None = None,
        *,
        folder: Path | None = None,
        language: str = FIRST,
    ) -> None:
        super().__init__(folder)
        self._language = known("a language", language, LANGUAGES)
        self._logbook = Logbook(self._language)
        self._plans: dict[str, FloorPlan] = {}
        self.plant(plant)

    def plant(self, plant: PlantModel | Path | str | None = None) -> PlantModel:
        """Choose the plant by its file, by the name of an example or as a model, before anything happens."""
        if isinstance(plant, str) and plant.isidentifier() and not Path(plant).exists():
            shipped = examples.folders()
            plant = Path(str(shipped[known("an example, and no file", plant, shipped)])) / examples.PLANT
        return super().plant(plant)

    def step(self, cell: str | None = None, *, at_most: float = STEP_AT_MOST_S) -> Table:
        """Let time pass until something new has happened, in this cell if one is named; return the new rows.

        Without news `at_most` s pass, and no row is returned.
        """
        of = None if cell is None else self.cell(cell).name
        rows = self._logbook.rows
        before = len(rows)

        def is_new() -> bool:
            return any(of in (None, row.cell) for row in rows[before:])

        self._do(lambda: self.world.advance(at_most, is_new))
        return Table(rows[before:], language=self._language)

    def table(self) -> Table:
        """All that happened so far, as the page's time line has it, and besides the steps and the faults."""
        return Table(self._logbook.rows, language=self._language)

    def tree(self, cell: str) -> Drawing:
        """The tree of the task that runs in a cell, or of the last one that ran there, with each result."""
        name = self.cell(cell).name
        tree = self._logbook.trees.get(name)
        if tree is None:
            return Drawing.of_words(texts(self._language, "notebook")["no_tree"].format(cell=name))
        return Drawing.of_tree(tree, language=self._language)

    def twin(self, cell: str) -> Drawing:
        """The devices of a cell where they truly are, from above, whatever the plant believes."""
        name = self.cell(cell).name
        plan = self._plans.setdefault(name, FloorPlan(self.world.model, name))
        return Drawing.of_scene(plan.scene(self._watched))

    def _repr_html_(self) -> str:
        language = words(self._language)
        heads = [f"<p><b>{escape(self.world.model.name)}</b>, {self.now:.2f} s</p>"]
        for cell in self.snapshot()["cells"]:
            name, why = (
                cell["name"],
                cell["held_by"] or cell["waiting_for"] or cell["not_ready"] or cell["step"],
            )
            state = ": ".join([language.cell(cell["state"]), *([language.say(why)] if why else [])])
            heads.append(f"<p><b>{escape(name)}</b>: {escape(state)}</p>")
            heads.append(f"<div>{self.tree(name).svg}</div><div>{self.twin(name).svg}</div>")
        return "".join(heads)

    def __repr__(self) -> str:
        cells = ", ".join(f"{cell['name']} {cell['state']}" for cell in self.snapshot()["cells"])
        return f"<world {self.world.model.name} at {self.now:.2f} s: {cells}>"

    def _made(self, tell: Callable[[str], None] | None = None) -> JudgedWorld:
        watched = super()._made(tell or self._logbook.hear)
        self._logbook.follow(watched)
        return watched
