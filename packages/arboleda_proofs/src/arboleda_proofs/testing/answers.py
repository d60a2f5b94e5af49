"""Answers that a test prepares for the next questions to a virtual device."""

from __future__ import annotations

from arboleda.drivers import DeviceVerb, Effect, Value
from arboleda.rig.world import World
from arboleda.sim.machine import MachineBody
from arboleda_proofs.simulator.people import answer_in_turn

from .words import Misuse, known

__tracebackhide__ = True


def prepare(world: World, device: str, verb: str, answers: tuple[Value, ...]) -> None:
    """Have a device answer the next questions of this verb so, one after the other; then as before."""
    board = world.boards.get(world.model.robots[device].mqtt)
    body = None if board is None else board.body
    queries = [each.name for each in _verbs(body) if each.effect is Effect.QUERY]
    if not isinstance(body, MachineBody) or not queries:
        raise Misuse(f"{device} is asked nothing; a person answers by sim.operate('answer', ...)")
    asked = known(f"a verb by which {device} is asked", verb, queries)
    allowed = body.kind.verbs[asked].answer_type
    for answer in answers:
        if allowed.read(answer) is None:
            words = allowed.allowed()
            raise Misuse(f"{device} {verb} never answers {answer!r}; its answers are {words}")
    answer_in_turn(body, verb, answers)


def _verbs(body: object) -> list[DeviceVerb]:
    return list(body.kind.verbs.values()) if isinstance(body, MachineBody) else []
