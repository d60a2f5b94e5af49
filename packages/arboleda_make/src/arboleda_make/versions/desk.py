"""VersionsApi of the plant in this process: puts versions of its files to work while it runs."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from arboleda.drivers import plain
from arboleda.engine import CellRun, Plant
from arboleda.engine.inspection import teaching_of
from arboleda.extension import ArboledaError, ConfigError, StartError
from arboleda.model.messages import RevisionAnswer, RevisionName
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.plant_file.draft import DraftCheck
from arboleda.plant_file.versions import Version, Versions, version_of, whole
from arboleda.runtime import at_work
from arboleda.runtime.parts.orchestrator import Orchestrator, PutToWork
from arboleda_make.drafts.api import DraftRefused, State
from arboleda_make.proposals.proposal import Proposal
from arboleda_make.versions.api import VersionsApi
from arboleda_make.versions.change import Change
from arboleda_make.versions.changes import changes
from arboleda_make.versions.restart import needing_restart

from ..drafts.plant_folder import PlantFolder

LOG = logging.getLogger("arboleda.operators")
PATIENCE_S = 30.0  # for the answer of the plant, which waits for its disk
UNKNOWN = "this plant does not keep what it was started with (record: off), so nothing can be compared"
MEANWHILE = "its files were changed while it was put to work; `arboleda apply` shows what they have now"
NO_RESTART = (
    "this plant is restarted by who started it; one that `arboleda up` runs alone can be restarted from here"
)
BY_HAND = (
    "the plant's files are not as they are at work: somebody edited them; `arboleda apply` or the page first"
)
OUTDATED = "it was made for another version of the plant than the one at work; it has to be proposed anew"
SAME = "the files are as they are at work"
NOW, AFTER_TASK, AT_REST = "now", "when task {task} has ended", "when it rests"
AFTER_TEACHING = "when nobody teaches it any more; `automatic {cell}` ends that"
Check = Callable[[PlantFiles, Path], DraftCheck]


class VersionDesk(VersionsApi):
    """VersionDesk: one version at a time, for threads of a server and for a signal; they wait for each other.

    `as_it_runs` makes of a plant as its files have it the one that runs here, at its rate and on its boards.
    Whoever writes the plant's files holds `writing`. `restarts`: whoever runs the plant starts it again where
    that is wanted.
    """

    def __init__(
        self,
        folder: PlantFolder,
        state: Path,
        plant: Orchestrator,
        *,
        as_it_runs: Callable[[PlantModel], PlantModel],
        check: Check,
        restarts: bool = False,
    ) -> None:
        self._folder = folder
        self._state = state
        self._plant = plant
        self._as_it_runs = as_it_runs
        self._check = check
        self._restarts = restarts
        self._turns = threading.Lock()
        self.writing = threading.Lock()

    def listed(self) -> State:
        started = self.at_work()
        kept = self._folder.versions
        known = [] if kept is None else kept.all()
        number = next((each.number for each in reversed(known) if each.digest == started.digest), None)
        rows = [_row(each, is_at_work=each.number == number) for each in known]
        cells, by = self._plant.loop.read(lambda plant: (_cells(plant), plant.restart_by))
        restart = {"by": by, "can": self._restarts}
        now = {"number": number, "at": started.at}
        return {"at_work": now, "versions": rows, "cells": cells, "restart": restart}

    def restart(self, by: str, *, wanted: bool) -> State:
        if not self._restarts:
            raise DraftRefused(NO_RESTART)
        found = self.listed()  # a plant at rest restarts as soon as it hears of it
        self._plant.restart_at_rest(by, wanted=wanted)
        return found | {"restart": {"by": by if wanted else "", "can": True}}

    def at_work(self) -> Version:
        """The files at work; DraftRefused where that is not known."""
        found = at_work.version(self._state)
        if found is None:
            raise DraftRefused(UNKNOWN)
        return found

    def put(self, number: int, by: str) -> State:
        with self._turns:
            kept = Versions(self._folder.ours)
            try:
                version = kept.find(number)
            except ConfigError as error:
                raise DraftRefused(str(error)) from error
            found = self._check(version.files, self._folder.ours)
            if found.problems or found.read is None:
                return _refused(found)
            if kept.is_in_place(version):
                return self._put(found, found.read, by, "")
            with self.writing:
                kept.bring_back(version)
            return self._put(found, found.read, by, f"version {number} again")

    def put_files(self, by: str) -> State:
        """Put to work what the files have now; as `put`."""
        with self._turns:
            found = self._check(self._on_disk(self.at_work()), self._folder.ours)
            if found.problems or found.read is None:
                return _refused(found)
            return self._put(found, found.read, by, "")

    def _put(self, found: DraftCheck, read: PlantFiles, by: str, note: str) -> State:
        """Keep as a version what was checked and is in its place, and put it to work."""
        started = self.at_work()
        fresh = version_of(read, at=_now(), by=by, note=note)
        differences = changes(whole(started), whole(fresh))
        if not differences:
            raise DraftRefused(SAME)
        kept = Versions(self._folder.ours)
        if kept.last() is None:  # so that there is a way back to it
            kept.keep(replace(started, note="as the plant was started"))
        fresh = replace(fresh, changes=tuple(each.words for each in differences))
        last = kept.last()
        is_kept = last is not None and last.digest == fresh.digest  # by `arboleda apply`
        version = last if last is not None and is_kept else kept.keep(fresh)
        return self._work_by(version, found, differences, by)

    def must_be_in_place(self, version: Version) -> None:
        """Raise DraftRefused where the plant's files are not those of a version: somebody edited them."""
        if not Versions(self._folder.ours).is_in_place(version):
            raise DraftRefused(BY_HAND)
        if others := Versions(self._folder.ours).others_now(version):
            raise DraftRefused(f"{BY_HAND} ({', '.join(map(plain, others))})")

    def put_approved(
        self, proposal: Proposal, approved: Callable[[], None], *, person: str, journal: str, note: str
    ) -> State:
        """Put to work what a person approved, as `put`; `approved` keeps that before anything is written.

        DraftRefused, and it is not kept, where the plant is another one than the proposal was made for.
        """
        with self._turns:
            base = self._still(proposal)
            found = self._check(proposal.files, self._folder.ours)
            if found.problems or found.read is None:
                return _refused(found)
            if version_of(found.read, at="").digest != proposal.content:
                raise DraftRefused(BY_HAND)
            differences = changes(whole(base), whole(version_of(found.read, at="")))
            with self.writing:
                self._still(proposal)
                approved()
                if not differences:
                    return {**_refused(found), "problems": ()}
                version = self._written(base, proposal, differences, person, note)
            return self._work_by(version, found, differences, journal)

    def _still(self, proposal: Proposal) -> Version:
        """The version at work; DraftRefused where it or the files are not what a proposal was made for."""
        base = self.at_work()
        if base.digest != proposal.base:
            raise DraftRefused(OUTDATED)
        self.must_be_in_place(base)
        return base

    def _written(
        self, base: Version, proposal: Proposal, differences: Sequence[Change], person: str, note: str
    ) -> Version:
        """The version that was approved, kept and in its place."""
        kept = Versions(self._folder.ours)
        if kept.last() is None:  # so that there is a way back to it
            kept.keep(replace(base, note="as the plant was started"))
        words = tuple(each.words for each in differences)
        fresh = Version(
            number=0,
            at=_now(),
            by=person,
            note=note,
            changes=words,
            files=proposal.files,
            others=proposal.others,
        )
        version = kept.keep(fresh)
        try:
            kept.bring_back(version)
        except StartError:
            kept.forget(version)
            raise
        return version

    def work_by(self, version: Version, found: DraftCheck, by: str) -> State:
        """Put a version to work whose files are in their place; as `put`."""
        with self._turns:
            return self._work_by(version, found, changes(whole(self.at_work()), whole(version)), by)

    def _work_by(self, version: Version, found: DraftCheck, differences: Sequence[Change], by: str) -> State:
        """Tell the plant of a version that is kept and whose files are in their place."""
        answer: State = {"version": version.number, "problems": (), "warnings": found.warnings, "cells": {}}
        restart = needing_restart(differences)
        if not restart:
            outcome = self._answer(version, by)
            restart = () if outcome.refusal is None else (str(outcome.refusal),)
            answer |= {"cells": _when(self._plant, outcome), "cancelled": outcome.cancelled}
        if restart:
            LOG.warning("version %d is kept; the next start of the plant has it", version.number)
            return answer | {"restart": restart, "cells": {}, "cancelled": ()}
        return answer | {"restart": ()}

    def _answer(self, version: Version, by: str) -> RevisionAnswer:
        """The answer of the plant to a version; the files are read again, without running any Python."""
        try:
            model, files = loader.load_with_files(self._folder.ours, runs=True)
        except ConfigError as error:
            raise DraftRefused(f"{MEANWHILE}: {error}") from error
        if version_of(files, at="").digest != version.digest:
            raise DraftRefused(MEANWHILE)
        name = RevisionName(digest=version.digest, number=version.number)
        put = PutToWork(name, self._as_it_runs(model), files, by, version.changes)
        answer = self._plant.revise(put).result(PATIENCE_S)
        if answer.refusal is None:
            at_work.keep(self._state, files, _now())
        return answer

    def _on_disk(self, started: Version) -> PlantFiles:
        """The plant file as it is now; the check reads what it uses."""
        file, name = self._folder.ours, started.files.plant
        try:
            return PlantFiles(plant=name, contents={name: file.read_bytes()})
        except OSError as error:
            raise ArboledaError(f"{file} cannot be read: {error.strerror}") from error


def _refused(found: DraftCheck) -> State:
    problems = found.problems or (MEANWHILE,)
    empty: dict[str, Any] = {"version": None, "cells": {}, "cancelled": (), "restart": ()}
    return empty | {"problems": problems, "warnings": found.warnings}


def _row(version: Version, *, is_at_work: bool) -> State:
    row = {"number": version.number, "at": version.at, "by": version.by, "note": version.note}
    return row | {"changes": list(version.changes), "is_at_work": is_at_work}


def _cells(plant: Plant) -> list[State]:
    """By cell the version that it took while the plant ran, and the one that it takes next and when."""
    return [
        {
            "cell": name,
            "version": None if run.version is None else run.version.number,
            "following": None if run.following is None else run.following.version.number,
            "when": NOW if run.following is None else _after(run),
        }
        for name, run in plant.cells.items()
    ]


def _when(plant: Orchestrator, answer: RevisionAnswer) -> dict[str, str]:
    waits = dict(answer.waits)
    return {
        name: _after(run, waits[name]) if name in waits else NOW for name, run in plant.plant.cells.items()
    }


def _after(run: CellRun, task: str = "") -> str:
    """The sentence for when a cell takes what it waits with: for `task`, if that is known."""
    task = task or (run.task.id if run.task else "")
    if task:
        return AFTER_TASK.format(task=task)
    return AT_REST if teaching_of(run) is None else AFTER_TEACHING.format(cell=run.cell.name)


def _now() -> str:
    return datetime.now(timezone.utc).isoformat(timespec="seconds")
