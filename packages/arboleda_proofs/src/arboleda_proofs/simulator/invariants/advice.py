"""Advice leads out: whoever follows it gets every cell to work again."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.engine import why_waiting
from arboleda.model.advice import in_words

from .invariant import Look, Trigger, invariant

ENOUGH = 6  # acts


@invariant(Trigger.ASKED)
def advice_leads_out(look: Look) -> Iterator[str]:
    """Once nothing goes wrong any more, the first advice leads each cell to work in at most six acts; one
    that is due for several of its devices, as to have each let go, counts once.
    """
    for name, acts in look.record.acts.of.items():
        if len(acts) > ENOUGH and _counted(acts) > ENOUGH:
            why = why_waiting(look.world.plant.cells[name])
            yield f"{name} does not work after {', '.join(acts)}: {why}"


def _counted(acts: list[str]) -> int:
    """The number of acts, of which those of one verb on different devices count as one."""
    verbs = {act: act.partition(" ")[0] for act in acts}
    return len(acts) - len(verbs) + len(set(verbs.values()))


@invariant(Trigger.ASKED)
def refusals_are_foretold(look: Look) -> Iterator[str]:
    """The refusal of a verb, or that it is not refused, is foretold just as it is answered then."""
    for request, foretold in look.record.before_requests.foretold:
        (answer,) = look.record.operator_requests.answers
        if answer.refusal != foretold:
            verb = f"{request.verb.value} {request.scope!r}"
            yield f"{verb} was answered with {answer.refusal}, foretold was {foretold}"


@invariant(Trigger.END)
def no_advice_where_all_is_well(look: Look) -> Iterator[str]:
    """At the end nothing is advised, as every cell works."""
    for name in look.world.plant.cells:
        for advice in look.world.plant.advice(name)[:1]:
            if advice.refusal is None:
                yield f"for {name} it is advised: {in_words(advice)}"
            else:
                yield f"for {name} it is advised: {in_words(advice)}, which is refused: {advice.refusal}"


ADVICE = (advice_leads_out, refusals_are_foretold, no_advice_where_all_is_well)
