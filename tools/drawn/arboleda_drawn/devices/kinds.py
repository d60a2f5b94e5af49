"""Kinds of devices drawn from a seed: facts of every type, and verbs of every effect."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from arboleda_proofs.simulator.chance import Dice

from .steps import Value


@dataclass(frozen=True, kw_only=True)
class Span:
    """A number within two limits, a whole one where both are, which only a kind in Python can say."""

    lower: float
    upper: float


Type = str | tuple[Value, ...] | Span  # bool, int, number, text, all the words that there are, or limits
Section = dict[str, Any]

FACTS = ("lid", "door", "lit", "level", "mode", "gate", "heat", "ram", "batch", "tray")
WORDS: tuple[tuple[Value, ...], ...] = (
    ("open", "closed"),
    ("up", "down"),
    ("abierto", "cerrado"),
    ("sí", "no"),
    ("grün", "rot", "weiß"),
    ("low", "mid", "high"),
    ("none", "entry", "exit"),
    (20, 40, 60),
    (0, 1),
    (1001, 1002, 1003),
)
PROGRAM = "program"  # the parameter by which a device works, which sets nothing
TEXTS = ("lot 7", "ñandú", "a", "Größe 3", "x-1_2")
SPANS = (Span(lower=0, upper=9), Span(lower=-40, upper=125), Span(lower=0.5, upper=2.0))
TIMES_S = (0, 0, 0.05, 0.2, 0.5, 1, 2, 4)
LONG_S = (6, 12, 25)
SPARE = "settle"
NEEDY = "vent"
SETTERS = ("put", "make", "bring", "move")
WORKS = ("run", "press", "spin", "rinse", "blow", "heat_up", "feed")
QUERIES = ("look", "scan", "weigh", "feel", "ask")
ANSWERS: tuple[tuple[Value, ...], ...] = (
    ("good", "bad"),
    ("sí", "no", "quizás"),
    ("enough", "short"),
    (1, 2, 3),
    ("ok",),
)


@dataclass(frozen=True, kw_only=True)
class Verb:
    """A verb of a kind; values of `sets` that begin with `$` are those of a parameter."""

    name: str
    effect: str
    parameters: tuple[tuple[str, Type], ...] = ()
    sets: tuple[tuple[str, Value], ...] = ()
    needs: tuple[tuple[str, Value], ...] = ()
    takes_s: float = 0
    at_most_s: float | None = None
    finishes: bool = False
    holds: bool = False
    works_on: bool = False
    makes: bool = False
    answers: tuple[Value, ...] = ()
    numbers: Type | None = None  # that it answers, in the place of words


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A kind: its facts in an order in which verbs that set one need only those before it.

    `spare` are a verb that sets two facts at once and a switch that needs a fact, which only trials tell.
    """

    name: str
    facts: tuple[tuple[str, Type], ...] = ()
    verbs: tuple[Verb, ...] = ()
    spare: tuple[Verb, ...] = ()
    clamp: str = ""  # the fact that says whether it holds a part
    is_shipped: bool = False
    is_written: bool = False  # in Python

    def type_of(self, fact: str) -> Type:
        return dict(self.facts)[fact]

    def verb(self, name: str) -> Verb:
        return next(each for each in self.all_verbs if each.name == name)

    @property
    def all_verbs(self) -> tuple[Verb, ...]:
        return (*self.verbs, *self.spare)

    def setters(self, fact: str) -> list[Verb]:
        """The verbs that set nothing but this fact."""
        return [each for each in self.verbs if [name for name, _ in each.sets] == [fact]]

    @property
    def has_query(self) -> bool:
        return any(verb.effect == "query" for verb in self.verbs)

    @property
    def is_settable(self) -> list[str]:
        """The facts that can be given every value."""
        return [name for name, _ in self.facts if name != self.clamp and self.setters(name)]

    @property
    def section(self) -> Section:
        """The kind as a plant file declares it."""
        facts = {name: list(type) if isinstance(type, tuple) else type for name, type in self.facts}
        verbs = {verb.name: _section(verb) for verb in self.all_verbs}
        return {**({"facts": facts} if facts else {}), "verbs": verbs}


def _section(verb: Verb) -> Section:
    section: Section = {"effect": verb.effect}
    if verb.parameters:
        section["with"] = {n: list(t) if isinstance(t, tuple) else t for n, t in verb.parameters}
    if verb.sets:
        section["sets"] = dict(verb.sets)
    if verb.needs:
        section["needs"] = dict(verb.needs)
    if verb.takes_s:
        section["takes_s"] = verb.takes_s
    if verb.at_most_s is not None:
        section["at_most_s"] = verb.at_most_s
    if verb.finishes:
        section["on_stop"] = "finish"
    if verb.holds:
        section["holds"] = "part"
    if verb.works_on:
        section["works_on"] = "part"
    if verb.makes:
        section["makes"] = "part"
    if verb.answers:
        section["answers"] = list(verb.answers)
    elif verb.numbers is not None:
        section["answers"] = verb.numbers
    return section


def draw_kind(dice: Dice, name: str, *, is_written: bool = False) -> Kind:
    """One kind; `is_written`: in Python, where numbers have limits."""
    return _KindDrawer(dice, name, is_written=is_written).draw()


class _KindDrawer:
    """Draws one kind, fact by fact."""

    def __init__(self, dice: Dice, name: str, *, is_written: bool) -> None:
        self._dice = dice
        self._name = name
        self._is_written = is_written
        self._facts: list[tuple[str, Type]] = []
        self._verbs: list[Verb] = []

    def draw(self) -> Kind:
        dice = self._dice
        for _ in range(dice.pick((0, 1, 1, 2, 2, 3))):
            self._fact()
        clamp = self._clamp() if dice.chance(0.3) else ""
        for _ in range(dice.pick((0, 1, 1, 2))):
            self._work()
        if dice.chance(0.45) or not self._verbs:
            self._query()
        if dice.chance(0.25):
            self._facts.append(("count", dice.pick(("int", "number", "text"))))  # reported, never set
        return Kind(
            name=self._name,
            facts=tuple(self._facts),
            verbs=tuple(self._verbs),
            clamp=clamp,
            is_written=self._is_written,
        )

    def _fact(self) -> None:
        dice = self._dice
        name = dice.pick([each for each in FACTS if each not in dict(self._facts)])
        type: Type = dice.pick(("bool", "int", "number", "text")) if dice.chance(0.4) else dice.pick(WORDS)
        type = self._limited(type)
        before = list(self._facts)
        self._facts.append((name, type))
        if isinstance(type, tuple) and dice.chance(0.5):
            for number, word in enumerate(type):
                self._set(f"{name}_{number}", name, word, (), before)
        else:
            self._set(f"{dice.pick(SETTERS)}_{name}", name, "$to", (("to", type),), before)

    def _limited(self, type: Type) -> Type:
        """The type, in a kind in Python mostly with limits where it is a number."""
        is_limited = self._is_written and type in ("int", "number") and self._dice.chance(0.8)
        return self._dice.pick(SPANS) if is_limited else type

    def _set(
        self,
        verb: str,
        fact: str,
        value: Value,
        parameters: tuple[tuple[str, Type], ...],
        before: list[tuple[str, Type]],
    ) -> None:
        effect = self._dice.pick(("motion", "motion", "process", "switch"))
        self._add(verb, effect, parameters=parameters, sets=((fact, value),), needs=self._needs(before))

    def _clamp(self) -> str:
        needs = self._needs(self._facts)
        self._facts.append(("clamped", "bool"))
        self._add(
            "clamp",
            "switch",
            parameters=(("on", "bool"),),
            sets=(("clamped", "$on"),),
            needs=needs if self._dice.chance(0.3) else (),
            holds=True,
        )
        return "clamped"

    def _work(self) -> None:
        dice = self._dice
        name = dice.pick([each for each in WORKS if each not in {verb.name for verb in self._verbs}])
        effect = dice.pick(("process", "process", "motion"))
        type: Type = dice.pick(WORDS) if dice.chance(0.6) else dice.pick(("int", "number", "bool", "text"))
        type = self._limited(type)
        parameters: tuple[tuple[str, Type], ...] = ((PROGRAM, type),) if dice.chance(0.5) else ()
        free = [each for each in self._facts if each[0] != "clamped"]
        self._add(name, effect, parameters=parameters, needs=self._needs(free))

    def _query(self) -> None:
        dice = self._dice
        free = [each for each in self._facts if each[0] != "clamped"]
        needs = self._needs(free) if dice.chance(0.5) else ()
        self._add(dice.pick(QUERIES), "query", needs=needs, answers=dice.pick(ANSWERS))

    def _needs(self, facts: list[tuple[str, Type]]) -> tuple[tuple[str, Value], ...]:
        dice = self._dice
        return tuple((name, value_of(dice, type)) for name, type in facts if dice.chance(0.4))

    def _add(self, name: str, effect: str, **more: Any) -> None:
        dice = self._dice
        takes_s = dice.pick(LONG_S) if dice.chance(0.1) else dice.pick(TIMES_S)
        at_most_s = round(takes_s * dice.pick((1.0, 2.0, 5.0)) + dice.pick((0.6, 1, 5)), 3)
        finishes = effect == "process" and dice.chance(0.35)
        self._verbs.append(
            Verb(
                name=name,
                effect=effect,
                takes_s=takes_s,
                at_most_s=at_most_s if dice.chance(0.4) else None,
                finishes=finishes,
                **more,
            )
        )


def with_spare(dice: Dice, kind: Kind) -> Kind:
    """The kind with a verb that sets two of its facts at once, and a switch of a fact that needs another one,
    where it has two that can be set.
    """
    settable = list(kind.is_settable)
    if len(settable) < 2:
        return kind
    first = dice.pick(settable)
    second = dice.pick([each for each in settable if each != first])
    sets = tuple((each, value_of(dice, kind.type_of(each))) for each in (first, second))
    effect = dice.pick(("switch", "switch", "process", "motion"))
    settle = Verb(name=SPARE, effect=effect, sets=sets, takes_s=dice.pick((0.2, 0.5, 1)))
    vent = Verb(name=NEEDY, effect="switch", sets=sets[1:], needs=sets[:1], takes_s=0.2)
    return replace(kind, spare=(settle, vent))


def value_of(dice: Dice, type: Type) -> Value:
    """A value of a type."""
    if isinstance(type, tuple):
        return dice.pick(type)
    if isinstance(type, Span):
        return dice.pick((type.lower, type.upper))
    if type == "bool":
        return dice.chance(0.5)
    if type == "int":
        return dice.pick((-3, 0, 1, 7, 100_000))
    if type == "number":
        return dice.pick((0.0, 0.5, -1.25, 3.0, 80.1))
    return dice.pick(TEXTS)


def another_value(dice: Dice, type: Type, value: Value) -> Value:
    """A value of a type that is not this one."""
    while (found := value_of(dice, type)) == value:
        pass
    return found


def shipped(name: str) -> Kind:
    """A kind that comes with Arboleda, in so far as recipes are drawn for it."""
    verbs = {
        "gripper": (
            Verb(name="close", effect="switch", holds=True, takes_s=0.5),
            Verb(name="open", effect="switch", holds=True, takes_s=0.5),
        ),
        "effector": (
            Verb(name="grip", effect="switch", holds=True),
            Verb(name="let_go", effect="switch", holds=True),
        ),
        "conveyor": (
            Verb(name="advance", effect="motion", parameters=(("to", ("entry", "exit")),), takes_s=3),
            Verb(name="clear", effect="motion", parameters=(("at", ("entry", "exit")),), takes_s=3),
        ),
        "camera": (Verb(name="look", effect="query", answers=("good", "bad"), takes_s=0.5),),
        "sensor": (Verb(name="read", effect="query", answers=("present", "absent"), takes_s=0.1),),
    }[name]
    return Kind(name=name, verbs=verbs, is_shipped=True)
