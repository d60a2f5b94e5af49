"""A proof as plain data, for `--json`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from arboleda import __version__
from arboleda.extension import ArboledaError
from arboleda.plant_check.check_answer import CheckAnswer
from arboleda.plant_check.unstated import unknowns

from .calm import Calm
from .checks import Check, tried_checks
from .equal_cells import equal_cells
from .outcome import plain
from .pairs import PairTally
from .proof_tally import Case, ProofTally
from .pytest_file import Breach, as_tests, lasting


def write(path: Path, content: str) -> None:
    """Write a file; ArboledaError where that cannot be."""
    try:
        path.write_text(content, encoding="utf-8")
    except OSError as error:
        raise ArboledaError(f"{path}: cannot be written: {error.strerror}") from None


def as_json(content: dict[str, Any]) -> str:
    """The answer as the content of a file."""
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def summary(
    plant: Path | None,
    calm: Sequence[Calm],
    tally: ProofTally,
    breaches: Sequence[Breach],
    total: int,
    *,
    complete: bool,
    mended: CheckAnswer,
    pairs: PairTally | None = None,
) -> dict[str, Any]:
    """The whole answer; `mended` has what the runs without faults found, and what would mend it."""
    model = tally.proof.model
    return {
        "arboleda": __version__,
        "plant": str(plant) if plant else None,
        "complete": complete,
        "runs": {"done": tally.runs, "of": total, "represented": tally.proof.represented},
        "pairs": None if pairs is None else {"done": pairs.runs, "of": pairs.pairs.total},
        "proved_as": {name: first for name, first in equal_cells(model).items() if name != first},
        "alone": round(tally.alone, 4),
        "unknown": list(unknowns(model)),
        **mended.plain,
        "scenarios": [_scenario(each) for each in calm],
        "table": [_row(*each) for each in tally.table().items()],
        "unnoticed": [
            {**_case(case), "runs": count, "checks": _checks(tried_checks(tally.proof, case))}
            for case, count in tally.unnoticed()
        ],
        "unmended": [{**_case(case), "runs": count} for case, count in tally.unmended()],
        "breaches": [_breach(each, plant) for each in breaches],
        "digests": [proved.digest for _, proved in sorted(tally.proved.items())],
    }


def _checks(tried: Sequence[Check] | None) -> list[dict[str, Any]] | None:
    return None if tried is None else [asdict(each) for each in tried]


def _scenario(calm: Calm) -> dict[str, Any]:
    scenario = calm.scenario
    return {
        "cell": scenario.cell,
        "recipe": scenario.recipe,
        "task": scenario.task,
        "answers": dict(scenario.answers),
        "brought": list(scenario.brought),
        "stands_for": scenario.alike,
        "without_faults": plain(calm.run.outcome),
        "finding": calm.finding,
        "once_more": calm.again,
        "ends_with": dict(calm.state),
        "instants": len(calm.instants),
    }


def _row(key: tuple[str, str], rows: dict[str, Any]) -> dict[str, Any]:
    faults = {
        kind: {
            "runs": row.runs,
            "ends": dict(sorted(row.ends.items())),
            "causes": dict(sorted(row.causes.items())),
            "alone": row.alone,
            "unnoticed": row.unnoticed,
            "broken": row.broken,
            "changes_with_the_moment": row.changes,
            "turns": [
                {"target": target, "at": [[instant.name, words] for instant, words in turns]}
                for target, turns in row.turns.items()
            ],
        }
        for kind, row in rows.items()
    }
    return {"cell": key[0], "recipe": key[1], "faults": faults}


def _case(case: Case) -> dict[str, Any]:
    return {
        "task": case.scenario.task,
        "answers": dict(case.scenario.answers),
        "brought": list(case.scenario.brought),
        "instant": case.instant.name,
        "fault": asdict(case.fault),
        "outcome": plain(case.outcome),
    }


def _breach(breach: Breach, plant: Path | None) -> dict[str, Any]:
    name, sentence = breach.run.outcome.broken or ("", "")
    return {
        "invariant": name,
        "seen": sentence,
        "task": breach.scenario.task,
        "answers": dict(breach.scenario.answers),
        "brought": list(breach.scenario.brought),
        "instant": breach.instant.name,
        "fault": asdict(lasting(breach.fault, breach.run)),
        "then": None if breach.then is None else asdict(breach.then),
        "runs": breach.count,
        "test": as_tests([breach], plant),
    }
