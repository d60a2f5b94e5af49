"""ProposalsApi of the plant in this process: what assistants propose, and what people decide."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import datetime, timezone
from difflib import unified_diff
from pathlib import Path
from typing import Any

from arboleda.drivers import among, plain, quoted
from arboleda.model.assistants import Assistants
from arboleda.plant_file.recipe_forms import XML
from arboleda.plant_file.versions import Version, version_of
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda_make.drafts.api import DraftRefused, State
from arboleda_make.drafts.draft import draft_of
from arboleda_make.drafts.process import CheckProcess
from arboleda_make.proposals.api import ProposalsApi
from arboleda_make.proposals.proposal import Proposal, ProposedChanges, proposed, readable

from ..drafts.plant_folder import PlantFolder
from ..versions.desk import OUTDATED, VersionDesk
from .pictures import picture_of
from .shelf import Decision, Shelf, Stage
from .tasks import AssistantTasks, Giving
from .tries import PROVING, SIMULATING, Tries

LOG = logging.getLogger("arboleda.operators")
KEPT = "prove"  # folder of runs that need not be run again
MOST_OPEN = 20
OPENED_AGAIN = (Stage.REPLACED, Stage.WITHDRAWN)  # by its assistant, and not by a person
LEVEL = "the plant file does not let assistants propose anything (`assistants: {level}`)"
EMPTY = "it changes nothing, and names no recipe for which it asks"
MANY = "there are {count} proposals that nobody has decided on; withdraw one first"
DECIDED = "this proposal is {stage} already{by}{reason}"
NOT_A_RECIPE = "{name} is no recipe of this plant or of this proposal; {among}"
NOTE = "proposal {name} {hash} by {by}"
PROPOSED_BY = "{person}, who approved proposal {hash} by {by}"


class ProposalDesk(ProposalsApi):
    """ProposalDesk: for threads of a server. One decision is made at a time, and what is proposed meanwhile
    waits for it, so what is approved is the content of that very hash."""

    def __init__(
        self,
        folder: PlantFolder,
        state: Path,
        versions: VersionDesk,
        process: CheckProcess,
        plant: Giving,
        clock: Callable[[], datetime] = datetime.now,
    ) -> None:
        self._folder = folder
        self._versions = versions
        self._process = process
        self._plant = plant
        self._shelf = Shelf(state)
        self._proofs = Tries(PROVING, state)
        self._simulations = Tries(SIMULATING, state)
        self._kept = state / KEPT
        self._tasks = AssistantTasks(self._shelf, plant, versions, clock)
        self._deciding = threading.Lock()

    def start(self) -> None:
        """Nothing: processes begin when somebody asks for them."""

    def stop(self) -> None:
        """End what is checked and tried. Idempotent."""
        self._process.stop()
        self._proofs.stop()
        self._simulations.stop()

    def base(self) -> State:
        version = self._versions.at_work()
        return {**readable(version.files), "version": version.digest}

    def propose(self, wanted: Mapping[str, Any]) -> State:
        self._must_be_let()
        base = self._versions.at_work()
        self._versions.must_be_in_place(base)
        proposal = self._made(base, wanted)
        known = next((pair for pair in self._shelf.all() if pair[0].hash == proposal.hash), None)
        if known is not None and known[1].stage not in OPENED_AGAIN:
            return {"hash": proposal.hash, "problems": (), **self._row(*known)}
        found = self._process.check(proposal.files, self._folder.ours)
        if found.problems or found.read is None:
            return {"hash": None, "problems": found.problems, "warnings": found.warnings}
        fresh = version_of(found.read, at=proposal.at)
        whole = replace(
            proposal, files=fresh.files, others=fresh.others, warnings=tuple(map(plain, found.warnings))
        )
        with self._deciding:
            self._keep(whole)
        LOG.info("%s proposes %s (%s)", quoted(whole.by), quoted(whole.name), whole.hash[:12])
        return {"problems": (), **self._row(*self._shelf.find(whole.hash))}

    def listed(self) -> list[State]:
        return [self._row(*pair) for pair in reversed(self._shelf.all())]

    def shown(self, hash: str) -> State:
        proposal, decision = self._shelf.find(hash)
        trees = {
            name: text.decode("utf-8", "replace")
            for name, text in proposal.files.contents.items()
            if name.endswith(XML)
        }
        before = self._versions.at_work().files.contents if self._fits(proposal) else {}
        differing = [name for name in trees if before.get(name) != proposal.files.contents[name]]
        return {
            **self._row(proposal, decision),
            "trees": trees,
            "differing": differing,
            "differences": _differences(before, proposal.files.contents),
            "pictures": {name: picture_of(name, proposal.files.contents[name]) for name in differing},
            "proof": self._proofs.result(hash),
            "proof_state": self._proofs.state(hash),
            "simulation": self._simulations.result(hash),
            "simulation_state": self._simulations.state(hash),
        }

    def prove(self, hash: str, recipes: Sequence[str], budget_s: float) -> State:
        proposal, decision = self._shelf.find(hash)
        self._must_be_open(decision)
        kept = str(self._kept.absolute())
        wanted = {"recipes": list(recipes), "kinds": [], "budget_s": budget_s, "kept": kept}
        return self._proofs.begin(proposal, self._folder.ours, wanted)

    def simulate(self, hash: str, seeds: int, cycles: int) -> State:
        proposal, decision = self._shelf.find(hash)
        self._must_be_open(decision)
        wanted = {"seeds": seeds, "cycles": cycles}
        return self._simulations.begin(proposal, self._folder.ours, wanted)

    def withdraw(self, hash: str) -> State:
        return self._end(hash, Stage.WITHDRAWN, by="", reason="")

    def reject(self, hash: str, by: str, reason: str) -> State:
        return self._end(hash, Stage.REJECTED, by=by, reason=reason)

    def approve(self, hash: str, by: str) -> State:
        with self._deciding:
            proposal, decision = self._shelf.find(hash)
            if decision.stage is not Stage.APPROVED:
                self._must_be_open(decision)
            elif decision.content == self._versions.at_work().digest:
                return {**_nothing_new(decision.version), **self._row(proposal, decision)}
            if not self._fits(proposal):
                raise DraftRefused(OUTDATED)
            return self._approve(proposal, decision, by)

    def submit(self, text: str, by: str) -> State:
        return self._tasks.submit(text, by)

    def _approve(self, proposal: Proposal, decision: Decision, by: str) -> State:
        """Keep the approval, and then put to work what was approved."""
        if decision.stage is not Stage.APPROVED:
            decision = Decision(stage=Stage.APPROVED, by=by, at=_now(), content=proposal.content)

        def approved() -> None:
            self._shelf.decide(proposal.hash, decision)
            LOG.info("proposal %s is approved by %s", proposal.hash[:12], plain(by))

        short, author = proposal.hash[:12], quoted(proposal.by)
        answer = self._versions.put_approved(
            proposal,
            approved,
            person=decision.by,
            journal=PROPOSED_BY.format(person=plain(decision.by), hash=short, by=author),
            note=NOTE.format(name=quoted(proposal.name), hash=short, by=author),
        )
        if answer["problems"]:
            return {**answer, **self._row(*self._shelf.find(proposal.hash))}
        done = replace(decision, version=answer["version"])
        self._shelf.decide(proposal.hash, done)
        self._shelf.forget_old(proposal.content)
        return {**self._row(proposal, done), **answer}

    def _made(self, base: Version, wanted: Mapping[str, Any]) -> Proposal:
        """The proposal of these changes to what is at work; DraftRefused where there can be none."""
        draft = draft_of(base.files)
        files = {name: self._folder.tree_name(draft, name) for name in wanted["trees"]}
        request = ProposedChanges(
            trees={files[name]: text for name, text in wanted["trees"].items()},
            values=[(tuple(place), value) for place, value in wanted["values"]],
            removed=[tuple(place) for place in wanted["removed"]],
        )
        try:
            draft = proposed(draft, request)
        except EditRefused as error:
            raise DraftRefused(error.sentence) from error
        recipes = tuple(sorted(set(wanted["recipes"])))
        self._must_be_recipes(recipes, [Path(each).stem for each in draft.files.contents])
        if not draft.changes and not recipes:
            raise DraftRefused(EMPTY)
        return Proposal(
            **{name: wanted[name] for name in ("name", "by", "words")},
            at=datetime.now(timezone.utc).isoformat(),
            base=base.digest,
            files=draft.files,
            others=base.others,
            recipes=recipes,
            changes=tuple(each.words for each in draft.changes),
        )

    def _must_be_recipes(self, names: Sequence[str], files: Sequence[str]) -> None:
        known = sorted({*(each.name for each in self._plant.model.recipes), *files[1:]})
        for name in names:
            if name not in known:
                raise DraftRefused(NOT_A_RECIPE.format(name=quoted(name), among=among(name, known)))

    def _keep(self, proposal: Proposal) -> None:
        """Keep a new proposal in the place of the open one with its name; what people decided meanwhile on
        the same content stays."""
        if self._shelf.decision(proposal.hash).stage not in (Stage.OPEN, *OPENED_AGAIN):
            return
        waiting = [each for each, decision in self._shelf.all() if decision.stage is Stage.OPEN]
        named = [each for each in waiting if (each.name, each.by) == (proposal.name, proposal.by)]
        replaced = [each for each in named if each.hash != proposal.hash]
        if len(waiting) - len(replaced) >= MOST_OPEN:
            raise DraftRefused(MANY.format(count=len(waiting)))
        self._shelf.keep(proposal)
        self._shelf.decide(proposal.hash, Decision())
        for each in replaced:
            gone = Decision(stage=Stage.REPLACED, at=_now(), reason=proposal.hash)
            self._shelf.decide(each.hash, gone)

    def _end(self, hash: str, stage: Stage, *, by: str, reason: str) -> State:
        with self._deciding:
            proposal, decision = self._shelf.find(hash)
            if decision.stage is stage:
                return self._row(proposal, decision)
            self._must_be_open(decision)
            done = Decision(stage=stage, by=by, at=_now(), reason=reason)
            self._shelf.decide(hash, done)
        LOG.info("proposal %s is %s by %s", hash[:12], stage.value, plain(by) or "its assistant")
        return self._row(proposal, done)

    def _must_be_let(self) -> None:
        level: Assistants = self._plant.model.assistants
        if not level.may_propose:
            raise DraftRefused(LEVEL.format(level=level.value))

    def _must_be_open(self, decision: Decision) -> None:
        if decision.stage is not Stage.OPEN:
            by = f" by {plain(decision.by)}" if decision.by else ""
            reason = f": {plain(decision.reason)}" if decision.reason else ""
            raise DraftRefused(DECIDED.format(stage=decision.stage.value, by=by, reason=reason))

    def _fits(self, proposal: Proposal) -> bool:
        """True if it was made for the version at work."""
        return proposal.base == self._versions.at_work().digest

    def _row(self, proposal: Proposal, decision: Decision) -> State:
        """A proposal without its trees."""
        return {
            **{name: getattr(proposal, name) for name in ("hash", "name", "by", "words", "at")},
            **{name: list(getattr(proposal, name)) for name in ("recipes", "changes", "warnings")},
            "made_for": proposal.base,
            "fits": self._fits(proposal),
            "stage": decision.stage.value,
            "decided_by": decision.by,
            "decided_at": decision.at,
            "reason": decision.reason,
            "version": decision.version,
        }


def _differences(before: Mapping[str, bytes], after: Mapping[str, bytes]) -> dict[str, str]:
    """By file of trees that differs its lines that come and go; nothing where another version is at work.

    What changes in the plant file is said in words: a line of it may have a password beside that.
    """
    return {
        name: "\n".join(unified_diff(_lines(before.get(name)), _lines(after.get(name)), lineterm="", n=2))
        for name in sorted(before.keys() | after.keys() if before else ())
        if name.endswith(XML) and before.get(name) != after.get(name)
    }


def _lines(content: bytes | None) -> list[str]:
    return [] if content is None else content.decode("utf-8", "replace").splitlines()


def _nothing_new(version: int | None) -> State:
    return {
        "version": version,
        "cells": {},
        "cancelled": (),
        "restart": (),
        "problems": (),
        "warnings": (),
    }


def _now() -> str:
    return datetime.now(timezone.utc).isoformat(timespec="seconds")
