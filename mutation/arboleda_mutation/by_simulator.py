"""The second judge: the simulator alone, seed by seed, until an invariant breaks.

Odd seeds run both packaged plants in turn, even ones a plant of their own that they draw.
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
LEVEL = "many"
LEAST_CPU_S = 30.0  # a seed takes a fraction of a second


def measure(root: Path, seeds: int, say: Say) -> dict[str, Any]:
    """What each seed reaches, with nothing planted."""
    tracer = Tracer(root / PACKAGE, MUTATED)
    with tracer.running():
        run = _runner()
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
        run = _runner()
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


def _runner() -> Any:
    """Runs one seed: the name of the invariant that breaks, or "". Imports what may have a bug."""
    from importlib.resources import as_file, files

    from arboleda.app import config
    from arboleda.app.simulate.drawn import Drawn
    from arboleda.app.simulate.plants import Plant
    from arboleda.app.simulate.setting import Setting
    from arboleda.app.simulate.workers import collect_rarely

    with as_file(files("arboleda").joinpath("plants", "shared.yaml")) as shared:
        packaged = tuple(Plant(declared=each) for each in (config.load(shared), config.load()))

    class Both:
        def of(self, seed: int) -> Plant:
            return packaged[seed // 2 % 2] if seed % 2 else Drawn().of(seed)

    setting = Setting(plants=Both(), cycles=0, level=LEVEL, seconds=SECONDS)
    collect_rarely()

    def run(seed: int) -> str:
        broken = setting.run(seed).broken
        return broken.invariant if broken else ""

    return run
