"""Symbolic state of a cell while a recipe is drawn: what is known of its facts, and what must stay."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from arboleda_proofs.simulator.chance import Dice

from .kinds import Verb, value_of
from .layout import Layout, Need
from .steps import Tell, Value


@dataclass(frozen=True, kw_only=True)
class State:
    """State: facts by role and name; `frozen` are those that nothing may change for now."""

    facts: dict[tuple[str, str], Value] = field(default_factory=dict)
    frozen: frozenset[tuple[str, str]] = frozenset()

    def knows(self, need: Need) -> bool:
        return self.facts.get(need[:2]) == need[2]

    def with_fact(self, role: str, fact: str, value: Value) -> State:
        return replace(self, facts={**self.facts, (role, fact): value})

    def unknown(self) -> State:
        """The same, with nothing known but what is frozen."""
        return replace(self, facts={key: value for key, value in self.facts.items() if key in self.frozen})

    def without(self, keys: Iterable[tuple[str, str]]) -> State:
        gone = set(keys)
        return replace(self, facts={key: value for key, value in self.facts.items() if key not in gone})

    def frozen_with(self, keys: Iterable[tuple[str, str]]) -> State:
        return replace(self, frozen=self.frozen | set(keys))

    def met(self, others: Iterable[State]) -> State:
        """The state of which all of these know."""
        known = [each.facts for each in others]
        if not known:
            return self
        rows = known[0].items()  # in their order, as what is drawn next depends on it
        return replace(
            self, facts={key: value for key, value in rows if all(_has(each, key, value) for each in known)}
        )


def _has(facts: Mapping[tuple[str, str], Value], key: tuple[str, str], value: Value) -> bool:
    return key in facts and facts[key] == value


class Planner:
    """Plans the verbs that make facts so; facts of higher rank first, as their verbs may need lower ones."""

    def __init__(self, layout: Layout, dice: Dice) -> None:
        self._layout = layout
        self._dice = dice

    def establish(self, state: State, goals: Iterable[Need]) -> tuple[list[Tell], State] | None:
        """Steps that make all goals so, and the state after them; None where that cannot be."""
        steps: list[Tell] = []
        wanted = sorted(goals, key=self._layout.rank, reverse=True)
        for goal in wanted:
            made = self._make(state, goal)
            if made is None:
                return None
            steps += made[0]
            state = made[1]
        return (steps, state) if all(state.knows(goal) for goal in wanted) else None

    def tell(
        self, state: State, role: str, verb: Verb, values: tuple[tuple[str, Value], ...], answer: str = ""
    ) -> tuple[list[Tell], State] | None:
        """A verb after those that make its needs so."""
        sets = [(fact, self._value(value, values)) for fact, value in verb.sets]
        if any(
            (role, fact) in state.frozen and state.facts.get((role, fact)) != value for fact, value in sets
        ):
            return None
        before = self.establish(state, self._layout.all_needs(role, verb))
        if before is None:
            return None
        steps, after = before
        for fact, value in sets:
            after = after.with_fact(role, fact, value)
        return [*steps, Tell(role=role, verb=verb.name, values=values, answer=answer)], after

    def values(self, verb: Verb) -> tuple[tuple[str, Value], ...]:
        """Drawn values of the parameters of a verb."""
        return tuple((name, value_of(self._dice, type)) for name, type in verb.parameters)

    def _make(self, state: State, goal: Need) -> tuple[list[Tell], State] | None:
        if state.knows(goal):
            return [], state
        role, fact, value = goal
        if (role, fact) in state.frozen:
            return None
        for verb in self._layout.device(role).kind.setters(fact):
            [(_, sets)] = verb.sets
            if sets == value and not verb.parameters:
                return self.tell(state, role, verb, ())
            if isinstance(sets, str) and sets.startswith("$") and len(verb.parameters) == 1:
                return self.tell(state, role, verb, ((verb.parameters[0][0], value),))
        return None

    def _value(self, value: Value, given: tuple[tuple[str, Value], ...]) -> Value:
        return dict(given)[value[1:]] if isinstance(value, str) and value.startswith("$") else value
