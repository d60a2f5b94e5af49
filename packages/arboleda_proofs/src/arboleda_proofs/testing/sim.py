"""Simulation for a test: a plant with virtual boards, network and faults, in which every step is judged."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

from arboleda.drivers import Value
from arboleda.model.messages import Verb
from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Build
from arboleda.model.verbs import from_text
from arboleda.rig.world import World
from arboleda.views import view
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.judged import judged_by
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld
from arboleda_proofs.simulator.levels import LEVELS
from arboleda_proofs.simulator.people import STANDS_BY_S, Attendant, FixedAnswers
from arboleda_proofs.simulator.run import NO_EXCEPTION

from . import arguments, looks, seeds, single_faults, wording
from .answers import prepare
from .desk import Desk, Handle
from .words import Misuse, known

AT_MOST_S = 600.0
T = TypeVar("T")
__tracebackhide__ = True  # a failed test shows where it stands, not how this file is written


class Sim:
    """One plant under virtual time; it starts with the first thing that is asked of it.

    A broken invariant of the simulator raises AssertionError, wherever it shows; a word that means nothing
    raises Misuse. Plant files are looked for in `folder` first.
    """

    _failure: type[AssertionError] = AssertionError

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder
        self._model: PlantModel | None = None
        self._recipes: dict[str, Build] = {}
        self._invariants: tuple[Invariant, ...] | None = None
        self._attendant: Attendant | None = None
        self._asking = False  # a condition of the test is being asked: what it raises is the test's
        self._has_timeline = False  # the error that ended the test has the timeline in it

    def plant(self, plant: PlantModel | Path | str | None = None) -> PlantModel:
        """Choose the plant by its file or as a model; None, and no choice at all, is the shipped plant."""
        self._before_start("plant")
        self._model = arguments.plant(plant, self._folder)
        return self._model

    def recipe(self, name: str, build: Build) -> None:
        """Have `build(order, context)` make the tree of every task of this recipe."""
        self._before_start("recipe")
        offered = dict.fromkeys(each.name for cell in self._chosen.cells for each in cell.recipes)
        self._recipes[known("a recipe", name, list(offered))] = build

    def without(self, *invariants: str) -> None:
        """Do not judge by these invariants, where a recipe means something else than the shipped one."""
        self._before_start("without")
        judges = judged_by() if self._invariants is None else self._invariants
        every = [each.name for each in judged_by()]
        names = {known("an invariant", name, every) for name in invariants}
        self._invariants = tuple(each for each in judges if each.name not in names)

    def submit(self, text: str) -> Handle:
        """Ask for a task; a refused one gets a handle, too."""
        return self._do(lambda: self._desk.submit(text))

    def operate(
        self, verb: Verb | str, scope: str = "", *, by_hand: bool = False, **arguments: int | str
    ) -> str | None:
        """Act as an operator; return the plant's reason for a refusal, or None if it did as asked.

        `arguments` are the verb's, as `operate("unload", "sis_a", station=7)`; without them `scope` may have
        them as an operator types them: `operate("unload", "sis_a 7")`.
        """
        word = Verb(known("a verb", verb, [each.value for each in Verb]))
        values = tuple(arguments.items())
        of, values = (scope, values) if values else from_text(word, scope)
        return self._do(lambda: self._desk.operate(word, of, by_hand=by_hand, arguments=values))

    def answers(self, device: str, verb: str, *answers: Value) -> None:
        """Have a device answer the next questions of this verb so, one after the other; then as before.

        A person is answered for by `operate("answer", "ana yes")`.
        """
        name = arguments.robot(device, self.world.model)
        prepare(self.world, name, verb, answers)

    def answer_always(self, **words: Value) -> None:
        """Have the devices and persons of these names answer that word where they can, and else the first."""
        for name in words:
            arguments.robot(name, self.world.model)
        FixedAnswers(self.world, words)

    def fault(
        self,
        kind: str,
        target: str = "",
        *,
        at: float | None = None,
        seconds: float | None = None,
        amount: float | None = None,
        word: str | None = None,
        seed: int = 0,
    ) -> Fault:
        """Have something go wrong in `at` s (None: now), for `seconds` (None: until `rest`).

        `kind` is one of `arboleda_proofs.simulator.faults.KINDS`, `target` a robot or what the kind befalls;
        `amount` and `word` are drawn with `seed` where they are None.
        """
        if at is not None and at < 0:
            raise Misuse(f"at is how many s from now a fault begins, 0 or more; is {at:g}")
        fault = arguments.fault(
            self.world.model,
            kind,
            target,
            at=self.now + (at or 0.0),
            seconds=seconds,
            amount=amount,
            word=word,
            seed=seed,
        )
        self._do(lambda: self._begin(fault) if at is None else self._watched.expect(fault))
        return fault

    def faults(self, faults: Iterable[Fault]) -> None:
        """Have faults go wrong at their own times, in s since the start of the simulation."""
        for fault in faults:
            arguments.must_fit(fault, self.world.model)
            self._watched.expect(fault)

    def run(
        self,
        seconds: float | None = None,
        *,
        until: Callable[[], object] | None = None,
        at_most: float = AT_MOST_S,
    ) -> None:
        """Let so many s pass, or until `until()` is true; raises AssertionError after `at_most` s."""
        if (seconds is None) == (until is None):
            raise Misuse("run(seconds) lets time pass, run(until=...) waits: one of them is needed")
        if seconds is not None and not 0 <= seconds < math.inf:
            raise Misuse(f"time only passes: seconds is 0 or more, is {seconds:g}")
        if seconds is not None:
            self._do(lambda: self.world.advance(seconds))
            return
        assert until is not None
        if not self._do(lambda: self.world.advance(at_most, lambda: self._ask(until))):
            self._has_timeline = True
            raise self._failure(wording.never(at_most, self._desk.tasks, self._watched))

    def rest(self) -> None:
        """End all faults, let an attendant get the cells going again, and judge that all comes to rest."""
        if self._attendant is None:
            self._attendant = Attendant(self.world, seed=0, round_s=STANDS_BY_S)
        self._do(self._watched.come_to_rest)

    def seeds(
        self, count: int, *, first: int = 1, cycles: int = seeds.CYCLES, faults: str = seeds.LEVEL
    ) -> None:
        """Run this plant `count` times with tasks, people and faults drawn from seeds, each to its rest.

        The first seed that breaks an invariant raises AssertionError, with as few faults as still break it;
        `faults` is a level of `arboleda_proofs.simulator.levels.LEVELS`.
        """
        level = known("a level of faults", faults, LEVELS)
        drawn = seeds.Seeds(
            model=self._chosen,
            cycles=cycles,
            level=level,
            recipes=self._recipes,
            invariants=judged_by() if self._invariants is None else self._invariants,
        )
        for seed in range(first, first + count):
            if (result := drawn.run(seed)).broken:
                raise self._failure(wording.seed(drawn.shrunk(result), drawn, len(result.faults)))

    def prove(self, recipe: str, *faults: str, at_most: int | None = single_faults.RUNS) -> float:
        """Try every single fault at every kind of moment of a recipe, one run each, in plants of their own.

        `faults` are the kinds that are tried, none: all; `at_most`: so many runs or a few more, the
        beginnings of steps first, None: all. Raises AssertionError where a run breaks an
        invariant, or the recipe fails without any fault; returns the share of all runs that was run.
        """
        if self._recipes or self._invariants is not None:
            raise Misuse(
                "prove tries the recipes of the plant by all invariants: without sim.recipe, sim.without"
            )
        return single_faults.prove(self._chosen, recipe, kinds=faults, at_most=at_most)

    @property
    def now(self) -> float:
        """The time since the simulation began, s."""
        return self._watched.seconds

    @property
    def world(self) -> World:
        """The simulated world, for all that `Sim` does not offer; its names may change with any version."""
        return self._watched.world

    def snapshot(self) -> dict[str, Any]:
        """The rows that a screen would show now; positions in rad and m."""
        return view.snapshot(self.world.plant)

    def cell(self, name: str) -> looks.CellLook:
        """A cell as it is now."""
        cells = [cell.name for cell in self.world.model.cells]
        return looks.cell(self.world, known("a cell of this plant", name, cells))

    def robot(self, name: str) -> looks.RobotLook:
        """A robot, by its name or its name on MQTT, as it is now and as the plant believes it to be."""
        return looks.robot(self.world, arguments.robot(name, self.world.model))

    def timeline(self) -> list[str]:
        """All that happened, a line each with its time in s, oldest first."""
        return self._watched.trace.lines

    def last_words(self) -> list[str]:
        """The end of the timeline, for a failed test that has not shown it."""
        lines = self.timeline() if self._started and not self._has_timeline else []
        return wording.timeline(lines) if lines else []

    def _before_start(self, what: str) -> None:
        if self._started:
            raise Misuse(f"sim.{what} comes before the simulation starts, so before submit, fault and run")

    @property
    def _started(self) -> bool:
        return "_watched" in vars(self)

    @cached_property
    def _watched(self) -> JudgedWorld:
        return self._made()

    def _made(self, tell: Callable[[str], None] | None = None) -> JudgedWorld:
        return JudgedWorld(
            self._chosen, invariants=self._invariants, keep=True, tell=tell, recipes=self._recipes
        )

    @property
    def _chosen(self) -> PlantModel:
        return self._model or arguments.plant(None, None)

    @cached_property
    def _desk(self) -> Desk:
        return Desk(self.world)

    def _begin(self, fault: Fault) -> None:
        self._watched.begin(fault)
        self.world.settle()

    def _ask(self, until: Callable[[], object]) -> bool:
        self._asking = True
        came = bool(until())
        self._asking = False
        return came

    def _do(self, act: Callable[[], T]) -> T:
        """The result of `act`; anything that goes wrong in the simulation meanwhile raises AssertionError."""
        self._asking = False
        try:
            return act()
        except BrokenInvariant as broken:
            breach, cause = broken, None
        except Exception as error:
            if self._asking:
                raise
            breach, cause = BrokenInvariant(NO_EXCEPTION, f"{type(error).__name__}: {error}"), error
        self._has_timeline = True
        raise self._failure(wording.breach(breach, self._watched)) from cause
