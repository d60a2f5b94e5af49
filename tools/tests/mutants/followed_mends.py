"""Follows the mends that `check` and `prove` propose for the bugs of `proof_bugs.py`, without any model.

`python -m tools.tests.mutants.followed_mends`, in the project's folder, says of each bug whether its plant is
mended by nothing but these answers; with names of plants, only of theirs. `--jobs N` processes share them.

The assistant here knows neither the bug nor the plant without it: it applies the edits that an answer states,
and looks again. The judge knows both: a plant counts as mended where nothing is found of it any more that is
not found of the plant without the bug, where each task leaves the same facts and parts, and where the mended
recipes are as good under the plant file without the bug.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import dataclass
from functools import cache
from multiprocessing import Pool
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

from arboleda.model.errors import ConfigError
from arboleda.plant_check import checks
from arboleda.plant_check.check_answer import check_answer
from arboleda.plant_check.mend import Mend, edited
from arboleda.plant_file import loader
from arboleda_make.mending.search import mend_of, texts_of
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.campaigns.proof.calm import calm_runs, run_findings
from arboleda_proofs.campaigns.proof.end_state import EndState
from arboleda_proofs.campaigns.proof.scenario import scenarios
from arboleda_proofs.campaigns.workers import collect_rarely

from .planted_proof import written
from .proof_bug import PLANT, ProofBug
from .proof_bugs import PROOF_BUGS

MOST_MENDS = 6  # that an assistant follows one after the other
MENDED, SILENT, LEFT, OTHER, WRONG = "mended", "nothing found", "no mend known", "other end", "wrong"


@dataclass(frozen=True, kw_only=True)
class Followed:
    """Result of an assistant: the verdict of the judge, and the mends that it followed."""

    verdict: str
    mends: tuple[str, ...]


def followed(file: Path) -> tuple[str, ...]:
    """The sentences of the mends that were applied to a plant's files, until no answer has one."""
    applied: list[str] = []
    while len(applied) < MOST_MENDS:
        mend = _answered(file)
        if mend is None:
            break
        for name, text in edited(texts_of(file), mend.edits).items():
            (file.parent / name).write_text(text, "utf-8")
        applied.append(mend.sentence)
    return tuple(applied)


def _answered(file: Path) -> Mend | None:
    """The mend of what `check` answers; where that finds nothing, of the runs of `prove` without faults."""
    answer = check_answer(file, mending=mend_of)
    if answer.findings:
        return answer.mend
    model = Plant(declared=loader.load(file)).model
    findings = tuple(each for calm in calm_runs(model, scenarios(model)) for each in run_findings(calm))
    return mend_of(file, findings) if findings else None


def judged(folder: Path, bug: ProofBug) -> Followed:
    """The result for a bug whose plant is written to a folder and mended there."""
    file = written(folder, bug.plant, bug)
    mends = followed(file)
    ends = ends_of(file)
    if ends is None:
        return Followed(verdict=LEFT, mends=mends)
    if not mends:
        return Followed(verdict=SILENT, mends=mends)
    if ends != _without_bug(bug.plant):
        return Followed(verdict=OTHER, mends=mends)
    with TemporaryDirectory() as other:
        whole = written(Path(other), bug.plant)
        for name, text in texts_of(file).items():
            if name != PLANT:
                (whole.parent / name).write_text(text, "utf-8")
        good = ends_of(whole) == _without_bug(bug.plant)
    return Followed(verdict=MENDED if good else WRONG, mends=mends)


def ends_of(file: Path) -> dict[str, EndState] | None:
    """The end state of each task where nothing goes wrong; None where anything is found of the plant."""
    try:
        declared = loader.load(file, apart=False)
    except ConfigError:
        return None
    if checks.warnings(declared):
        return None
    model = Plant(declared=declared).model
    runs = [*calm_runs(model, scenarios(model))]
    if not all(each.is_sound and not each.again for each in runs):
        return None
    return {each.scenario.name: each.state for each in runs}


@cache
def _without_bug(plant: str) -> dict[str, EndState] | None:
    with TemporaryDirectory() as folder:
        return ends_of(written(Path(folder), plant))


def _row(bug: ProofBug) -> tuple[ProofBug, Followed, float]:
    collect_rarely()
    began = process_time()
    with TemporaryDirectory() as folder:
        return bug, judged(Path(folder), bug), process_time() - began


def main() -> None:
    """Say of each bug what came of the assistant, and how many are mended."""
    words = sys.argv[1:]
    jobs = int(words.pop(words.index("--jobs") + 1)) if "--jobs" in words else None
    names = {each for each in words if each != "--jobs"}
    bugs = [each for each in PROOF_BUGS if not names or each.plant in names]
    verdicts: Counter[str] = Counter()
    with Pool(jobs) as pool:
        for bug, found, seconds in pool.imap(_row, bugs):
            verdicts[found.verdict] += 1
            mends = "; ".join(found.mends)
            print(f"{bug.plant}: {bug.about}  {found.verdict}: {mends}  {seconds:.0f} s", flush=True)
    print(f"{verdicts[MENDED]} of {len(bugs)} are mended; {dict(verdicts)}")


if __name__ == "__main__":
    main()
