"""Invariants of conclusions: the plant concludes of its commands no more, less or later than robots said."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.departures.leaving import WORTH_TELLING_S
from arboleda.drivers import Evidence, Query, Switch
from arboleda.engine import State
from arboleda.model.messages import Reason

from ..recorded.commands import SentCommand
from ..recorded.proofs import Proof, cause_text
from .invariant import Look, Trigger, invariant

NOTHING_SAID = Proof()
ANSWERED = frozenset({State.RUNNING, State.DONE})
ROUNDING_S = 1e-6


@invariant(Trigger.HEARD)
def proofs_end_commands(look: Look) -> Iterable[str]:
    """A report that proves the end of an open command ends it; one that shows it under way counts so."""
    record = look.record
    for id, proof in record.proofs.of.items():
        sent = record.commands.open.get(id)
        if sent is None:
            continue
        if proof.must_end:
            yield f"{sent} is still {_word(sent)}, though {proof.must_end}"
        if proof.must_run and sent.state is State.SENT:
            yield f"{sent} is taken for not accepted, though its board has named it"


@invariant(Trigger.NEWS)
def ends_are_proven(look: Look) -> Iterator[str]:
    """A command changes its state only for what was said after it was sent, or for its time being over."""
    record = look.record
    for sent, before in record.commands.moved:
        proof = record.proofs.of.get(sent.command.id, NOTHING_SAID)
        if sent in record.commands.new:
            if sent.state in ANSWERED and not _has_reported_since(look, sent):
                yield f"{sent} is {_word(sent)} in the step that sent it, and nobody has said so"
        elif sent.state is State.RUNNING and before is State.SENT and not proof.named:
            yield f"{sent} is taken for accepted, which nobody has said"
        elif sent.state is State.DONE and not (proof.done or _settled(look, sent)):
            yield f"{sent} is taken for done, which nobody has said since it was sent"
        elif sent.state is State.CANCELLED and not (proof.still or proof.must_end or _is_over(look, sent)):
            yield f"{sent} is taken for halted, and nobody has said that it stands still"
        elif sent.state is State.FAILED:
            yield from _wrong_cause(look, sent, proof)


def _is_over(look: Look, sent: SentCommand) -> bool:
    """True if a command needs no word of its robot to end: a question, and what never left."""
    return isinstance(sent.command, Query) or _has_not_left(look, sent)


def _has_not_left(look: Look, sent: SentCommand) -> bool:
    return sent.command.id in look.moment.undelivered


def _has_reported_since(look: Look, sent: SentCommand) -> bool:
    return any(each.robot == sent.robot and each.at >= sent.at for each in look.moment.reports)


def _word(sent: SentCommand) -> str:
    return sent.state.value if sent.state else "open"


def _settled(look: Look, sent: SentCommand) -> bool:
    """True if a command that its robot need not answer counts as done, as its time is over.

    So do an effector that reports nothing and, at `state`, a move to where the robot is already.
    """
    evidence, timing = look.world.model.robots[sent.robot].evidence, sent.timing
    late_s = sent.late_s if sent.late_s >= WORTH_TELLING_S else 0.0  # the plant takes no notice of less
    passed_s = look.record.step.at - sent.at - late_s + ROUNDING_S
    if isinstance(sent.command, Switch):
        return evidence is not Evidence.IDS and passed_s >= timing.effector_settle_s + sent.command.takes_s
    return evidence is Evidence.STATE and passed_s >= min(timing.stop_timeout_s, sent.deadline - sent.at)


def _wrong_cause(look: Look, sent: SentCommand, proof: Proof) -> Iterator[str]:
    failure = sent.entry.failure if sent.entry else None
    if failure is None:
        yield f"{sent} failed without a cause"
    elif failure.reason not in proof.causes | _by_time(look, sent):
        yield f"{sent} failed for {cause_text(failure)}, which is not what happened"


def _by_time(look: Look, sent: SentCommand) -> set[Reason]:
    """The reasons for which it may fail now though its robot says nothing."""
    record, known = look.record, look.record.robots[sent.robot]
    is_cut_off = known.stale_at <= record.step.at or _has_not_left(look, sent)
    found = {Reason.LINK_LOST} if is_cut_off else set()
    if sent.entry is not None and sent.entry.deadline <= record.step.at + ROUNDING_S:
        found.add(Reason.STOP_UNCONFIRMED if sent.cancelled_at is not None else Reason.DEADLINE)
    return found


PROOFS = (proofs_end_commands, ends_are_proven)
