"""A campaign as plain data, for `--json`."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import Any

from arboleda import __version__
from arboleda.extension import ArboledaError
from arboleda_proofs.simulator.findings import Finding

from .request import Request
from .search import ShrunkBreach
from .setting import rules
from .tally import Tally


def write(path: Path, request: Request, tally: Tally, shrunk: ShrunkBreach | None, *, complete: bool) -> None:
    """Write the summary; `shrunk` is the run of one of the broken seeds with the needed faults and plant."""
    data = summary(request, tally, shrunk, complete=complete)
    try:
        path.write_text(json.dumps(data, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    except OSError as error:
        raise ArboledaError(f"{path}: cannot be written: {error.strerror}") from None


def summary(request: Request, tally: Tally, shrunk: ShrunkBreach | None, *, complete: bool) -> dict[str, Any]:
    rows = [
        {**row, "broken": _broken(request, tally, seed, shrunk)} for seed, row in sorted(tally.rows.items())
    ]
    return {
        "arboleda": __version__,
        "plant": str(request.plant) if request.plant else None,
        "cycles": request.cycles,
        "level": request.faults,
        "standby": request.two_hosts,
        "revisions": request.changes_files,
        "complete": complete,
        "unknown": request.unjudged,
        "totals": {
            "seeds": len(rows),
            "broken": len(tally.broken),
            "cycles": tally.cycles,
            "seconds": round(tally.seconds, 3),
            "checks": tally.checks,
            "faults": dict(sorted(tally.faults.items())),
            "outcomes": dict(sorted(tally.outcomes.items())),
        },
        "findings": _counted(tally.findings),
        "as_written": _counted(tally.as_written),
        "seeds": rows,
    }


def _counted(found: Counter[Finding]) -> list[dict[str, Any]]:
    return [{**asdict(each), "kind": each.kind.value, "count": count} for each, count in found.items()]


def _broken(request: Request, tally: Tally, seed: int, shrunk: ShrunkBreach | None) -> dict[str, Any] | None:
    found = tally.broken.get(seed)
    if found is None:
        return None
    fewest = shrunk if shrunk and shrunk.result.seed == seed else None
    best = fewest.result if fewest else found
    plant = fewest.plant if fewest else request.plants.of(seed)
    assert best.broken is not None
    return {
        "invariant": best.broken.invariant,
        "must_hold": rules(plant).get(best.broken.invariant, ""),
        "seen": best.broken.sentence,
        "seconds": round(best.seconds, 3),
        "minutes": best.minutes,
        "injected": len(found.faults),
        "shrunk": fewest is not None,
        "faults": [asdict(fault) for fault in best.faults],
        **(
            {"people": request.faults_file.climate["people"]}
            if request.faults_file and request.has_people
            else {}
        ),
        **plant.plain,
        "replay": request.replay(seed),
    }
