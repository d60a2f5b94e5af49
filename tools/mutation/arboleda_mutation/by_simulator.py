"""The second judge: the simulator alone, seed by seed, until an invariant breaks.

Seeds take turns: every kind of fault on both packaged plants, on plants that they draw, and on the examples
of cells of devices, which have recipes of their own; plants that die again and again; plants on two hosts. In
some turns about half of the tasks are for several cells.
"""

from __future__ import annotations

import signal
import time
from pathlib import Path
from typing import Any

from .children import Say
from .mutant import Mutant
from .planted import plant
from .reach import Reach, Tracer
from .sources import MUTATED, PACKAGE, Sources

SECONDS = 20.0  # for which faults come; then everything has to come to rest
MANY, CRASHES = "many", "crashes"
EXAMPLES = ("machine_tending", "own_tree", "lab_bench")
LEAST_CPU_S = 30.0  # a seed takes a fraction of a second


def measure(root: Path, seeds: int, say: Say) -> dict[str, Any]:
    """Lines that each seed reaches, with nothing planted."""
    tracer = Tracer(root / PACKAGE, MUTATED)
    with tracer.running():
        run = _runner(root)
        for seed in range(1, seeds + 1):
            began = time.process_time()
            with tracer.during(str(seed)):
                broken = run(seed)
            tracer.reach.cpu_s.append(round(time.process_time() - began, 3))
            if broken:
                tracer.reach.failed.append(str(seed))
            say({"at": str(seed)})
    return tracer.reach.as_json()


def judge(sources: Sources, mutant: Mutant, seeds: list[int], say: Say) -> dict[str, Any]:
    """Run these seeds until one breaks."""
    plant(mutant, sources)
    try:
        run = _runner(sources.root)
    except Exception as error:  # noqa: BLE001 - a plant that cannot even be built is found at once
        return {"killed": True, "by": f"{type(error).__name__} before the first seed", "ran": 0}
    for number, seed in enumerate(seeds, start=1):
        say({"at": f"seed {seed}"})
        signal.setitimer(signal.ITIMER_PROF, LEAST_CPU_S)
        broken = run(seed)
        if broken:
            return {"killed": True, "by": f"seed {seed}: {broken}", "ran": number}
    return {"killed": False, "by": "", "ran": len(seeds)}


def in_order(mutant: Mutant, reach: Reach, seeds: range, before: str) -> list[int]:
    """Those of the seeds that come by a mutant, first the one that killed it before."""
    first = before.removeprefix("seed ").partition(":")[0]
    names = [name for name in reach.of(mutant) if name not in reach.failed and int(name) in seeds]
    return [int(name) for name in sorted(names, key=lambda name: (name != first, int(name)))]


def _runner(root: Path) -> Any:
    """Runs one seed: the name of the invariant that breaks, or "". Imports what may have a bug."""
    from importlib.resources import as_file, files

    from arboleda.plant_file import loader
    from arboleda_drawn.plants import DrawnPlants
    from arboleda_proofs.campaigns.plants import Plant
    from arboleda_proofs.campaigns.setting import Setting
    from arboleda_proofs.campaigns.workers import collect_rarely

    class Turns:
        """Plants of which each turn takes the next one."""

        def __init__(self, *plants: Plant) -> None:
            self._plants = plants

        def of(self, seed: int) -> Plant:
            return self._plants[seed // len(settings) % len(self._plants)]

    def setting(plants: Any, level: str, *, any_of: bool = False, standby: bool = False) -> Setting:
        return Setting(plants=plants, cycles=0, level=level, seconds=SECONDS, any_of=any_of, standby=standby)

    with as_file(files("arboleda") / "plants" / "shared.yaml") as shared:
        packaged = Turns(*(Plant(declared=each) for each in (loader.load(shared), loader.load())))
    paths = [root / "examples" / name / "plant.yaml" for name in EXAMPLES]
    examples = Turns(*(Plant(declared=loader.load(path)) for path in paths))
    settings = (
        setting(packaged, MANY),
        setting(DrawnPlants(), MANY),
        setting(examples, MANY),
        setting(packaged, CRASHES, any_of=True),
        setting(DrawnPlants(), MANY, any_of=True),
        setting(examples, CRASHES),
        setting(packaged, MANY, standby=True),
    )
    collect_rarely()

    def run(seed: int) -> str:
        broken = settings[seed % len(settings)].run(seed).broken
        return broken.invariant if broken else ""

    return run
