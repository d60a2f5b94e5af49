"""One seed from its first step to rest: faults, people, truth, record and invariants joined to a world."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from arboleda.engine import Plant
from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Builders

from .faults import Fault
from .findings import Finding
from .invariants import Invariant
from .judged_world import BrokenInvariant, JudgedWorld
from .people import Attendant, Customers, answer_anything
from .revisions import Revisions
from .scripted_people import Script, ScriptedPeople
from .split_reports import come_apart

MINUTE_S = 60.0
PATIENCE = 20  # minutes of faults so dense that nothing gets done, and one more for each cycle that is wanted
NO_EXCEPTION = "no_exception"

Plan = Callable[[int], Iterable[Fault]]  # minute of the run -> its faults


@dataclass(kw_only=True)
class Result:
    """Result of one run; times in s since it began. `broken` is None if every invariant held."""

    seed: int
    digest: str = ""
    seconds: float = 0.0
    cycles: int = 0
    faults: list[Fault] = field(default_factory=list)
    outcomes: dict[str, int] = field(default_factory=dict)
    checks: Counter[str] = field(default_factory=Counter)
    minutes: int = 0
    in_vain: bool = False  # it ended because no task of any cell told a device to do anything
    broken: BrokenInvariant | None = None
    findings: Counter[Finding] = field(default_factory=Counter)  # of a run without faults
    as_written: Counter[Finding] = field(default_factory=Counter)  # failures that recipes ask for in it
    lines: list[str] = field(default_factory=list)


class Simulation:
    """A world with people and faults; `run` goes on for so many cycles, or so many seconds, and then to rest.

    Cycles that do not come are not waited for once many tasks in a row have told no device to do anything.

    `plan` gives the faults of each minute; the same model, seed and plan give the same `digest`. With a
    `script` people do what it says and no tasks are drawn: the run ends after it, once its tasks have ended.
    With `any_of` customers name several cells for about half of their tasks.
    `standby`: a second host waits to lead. `revises`: engineers put other versions of the plant to work.
    """

    def __init__(
        self,
        model: PlantModel,
        seed: int,
        plan: Plan,
        *,
        invariants: Iterable[Invariant] | None = None,
        keep: bool = False,
        tell: Callable[[str], None] | None = None,
        recipes: Builders | None = None,
        make_plant: Callable[..., Plant] | None = None,
        script: Script | None = None,
        any_of: bool = False,
        standby: bool = False,
        revises: bool = False,
    ) -> None:
        self.watched = JudgedWorld(
            model,
            invariants=invariants,
            keep=keep,
            tell=tell,
            recipes=recipes,
            make_plant=make_plant,
            standby=standby,
        )
        self.world, self.trace = self.watched.world, self.watched.trace
        self.result = Result(seed=seed, faults=self.watched.faults)
        self._plan = plan
        come_apart(self.world, seed)
        answer_anything(self.world, seed)
        self._engineers = Revisions(self.world, seed) if revises else None
        self._script = script
        self._people = (
            self._customers(seed, any_of=any_of) if script is None else self._scripted(script, seed)
        )

    def _customers(self, seed: int, *, any_of: bool) -> Customers:
        customers = Customers(self.world, seed, any_of=any_of)
        Attendant(self.world, seed)
        return customers

    def _scripted(self, script: Script, seed: int) -> ScriptedPeople:
        return ScriptedPeople(self.world, script, lambda: Attendant(self.world, seed))

    @property
    def cycles(self) -> int:
        """The number of tasks that have ended so far and had told a device to do something."""
        return self._people.cycles

    def run(self, *, cycles: int | None = None, seconds: float | None = None) -> Result:
        """Run by the minute until `cycles` or `seconds` are reached, then to rest; a breach ends it."""
        if seconds is None and self._script is not None:
            seconds = self._script.seconds
        try:
            while not self._enough(cycles, seconds):
                self._minute(self.result.minutes, math.inf if seconds is None else seconds)
            self._people.go()
            self.watched.findings.nobody_asks = self._script is None
            if self._engineers is not None:
                self._engineers.go()
            self.watched.come_to_rest()
        except BrokenInvariant as broken:
            self.result.broken = broken
        except Exception as error:  # noqa: BLE001 - that none escapes is one of the invariants
            self.result.broken = BrokenInvariant(NO_EXCEPTION, f"{type(error).__name__}: {error}")
        return self._finished()

    def _enough(self, cycles: int | None, seconds: float | None) -> bool:
        if seconds is not None:
            return self.result.minutes * MINUTE_S >= seconds
        if isinstance(self._people, ScriptedPeople) and self._script is not None:
            patience = PATIENCE + math.ceil(self._script.ends / MINUTE_S)
            return self._people.over or self.result.minutes >= patience
        wanted = cycles or 0
        if isinstance(self._people, Customers) and self._people.gave_up:
            self.result.in_vain = True
        is_long = self.result.minutes >= PATIENCE + wanted
        return self.result.in_vain or is_long or self._people.cycles >= wanted

    def _minute(self, minute: int, seconds: float) -> None:
        self.result.minutes += 1
        for fault in self._plan(minute):
            self.watched.expect(fault)
        self.world.advance(min((minute + 1) * MINUTE_S, seconds) - self.watched.seconds)

    def _finished(self) -> Result:
        result = self.result
        result.digest, result.lines = self.trace.digest, self.trace.lines
        result.seconds, result.checks = self.watched.seconds, self.watched.checks
        if not result.faults and self._script is None:
            result.findings, result.as_written = self.watched.findings.found, self.watched.findings.as_written
        result.cycles, result.outcomes = self._people.cycles, self._people.outcomes
        return result
