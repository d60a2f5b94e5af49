"""Verbs of a kind that is written in Python."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from arboleda.model.commands import OnStop
from arboleda.model.errors import ArboledaError
from arboleda.model.facts import Value

from .declared import Computed, Effect, FactType

Sets = Mapping[str, Value] | Callable[..., Mapping[str, Value]]
"""The facts that a verb sets, `"$mm"` for the value of its parameter mm; or a function of its parameters."""
Seconds = float | Callable[..., float]


class KindError(ArboledaError):
    """Error in a kind, or in the settings that a plant file gives it; the sentence tells the reason."""


@dataclass(frozen=True)
class Number:
    """Number within two limits, both included: `Number(0.5, 2.0)`; an int if both are: `Number(1, 40)`.

    Raises KindError unless both limits are finite and `lower` is less than `upper`.
    """

    lower: float
    upper: float

    def __post_init__(self) -> None:
        if not -math.inf < self.lower < self.upper < math.inf:
            raise KindError(f"a Number has two limits, the lower one first: Number(1, 40); not {self}")

    @property
    def type(self) -> FactType:
        whole = isinstance(self.lower, int) and isinstance(self.upper, int)
        of: type[Value] = int if whole else float
        return FactType(type=of, first=of(self.lower), lower=self.lower, upper=self.upper)


Answers = Sequence[Value] | Number | type[float] | type[int]


@dataclass(frozen=True, kw_only=True)
class Verb:
    """Verb of a kind: one action of its devices. `motion`, `process`, `switch` and `query` make one.

    - `parameters`: the type of each parameter, by name: bool, int, float, str, a list of words or numbers,
      or `Number(lower, upper)`.
    - `sets`: the value of each fact that the verb makes true, by name; `"$mm"` is the value of the parameter
      mm. Or a function of the parameters, given by name, that returns such a mapping.
    - `needs`: the value that each of these facts must have for the verb to begin, by name; {} says that it
      needs nothing.
    - `takes_s`: the time that a virtual device takes, s; or a function of the parameters that returns it.
    - `at_most_s`: the time after which the verb has failed, s. None: three times `takes_s`, and at least 2 s;
      it must be given where `takes_s` is a function.
    - `virtual`: a function of the facts (a dict) and of the parameters, by name. It returns the further facts
      that a virtual device shows afterwards, by name; for a query, the answer. None: no further facts; for a
      query, the first answer.
    - `on_stop`: HALT ends the verb at a stop, FINISH lets it go on.
    - `works_on_part`: there has to be a part at a place of the device for the verb to begin.
    - `makes_part`: the verb makes a part, which lies at a place of the device from its beginning on.
    - `holds_part`: the one bool among `sets` tells whether the device holds a part.
    - `answers`: all answers to a query, words or numbers; float, int or `Number(lower, upper)` for a number.

    The functions depend on nothing but their arguments. `Kind` raises KindError for a verb that does not fit.
    """

    effect: Effect
    parameters: Mapping[str, object] = field(default_factory=dict)
    sets: Sets = field(default_factory=dict)
    needs: Mapping[str, Value] | None = None
    takes_s: Seconds = 0.0
    at_most_s: float | None = None
    on_stop: OnStop = OnStop.HALT
    works_on_part: bool = False
    makes_part: bool = False
    holds_part: bool = False
    answers: Answers = ()
    virtual: Computed | None = None


def motion(
    *,
    parameters: Mapping[str, object] | None = None,
    sets: Sets | None = None,
    needs: Mapping[str, Value] | None = None,
    takes_s: Seconds = 0.0,
    at_most_s: float | None = None,
    works_on_part: bool = False,
    virtual: Computed | None = None,
) -> Verb:
    """Returns a verb that moves something of the device, and that a stop halts.

    The parameters are those of `Verb`.
    """
    return Verb(
        effect=Effect.MOTION,
        parameters=parameters or {},
        sets=sets or {},
        needs=needs,
        takes_s=takes_s,
        at_most_s=at_most_s,
        works_on_part=works_on_part,
        virtual=virtual,
    )


def process(
    *,
    parameters: Mapping[str, object] | None = None,
    sets: Sets | None = None,
    needs: Mapping[str, Value] | None = None,
    takes_s: Seconds = 0.0,
    at_most_s: float | None = None,
    finishes: bool = False,
    works_on_part: bool = False,
    makes_part: bool = False,
    virtual: Computed | None = None,
) -> Verb:
    """Returns a verb for work that the device does by itself, such as a machine's program.

    `finishes`: the work goes on through a stop, instead of being halted. The other parameters are those of
    `Verb`.
    """
    return Verb(
        effect=Effect.PROCESS,
        parameters=parameters or {},
        sets=sets or {},
        needs=needs,
        takes_s=takes_s,
        at_most_s=at_most_s,
        on_stop=OnStop.FINISH if finishes else OnStop.HALT,
        works_on_part=works_on_part,
        makes_part=makes_part,
        virtual=virtual,
    )


def switch(
    *,
    sets: Sets,
    parameters: Mapping[str, object] | None = None,
    needs: Mapping[str, Value] | None = None,
    takes_s: Seconds = 0.0,
    at_most_s: float | None = None,
    holds_part: bool = False,
    virtual: Computed | None = None,
) -> Verb:
    """Returns a verb that sets something which stays as it is set, such as a valve; a stop does not undo it.

    `holds_part`: the verb takes or releases a part; exactly one of `sets`, which is no function then, is a
    bool: True if the device holds a part afterwards. The other parameters are those of `Verb`.
    """
    return Verb(
        effect=Effect.SWITCH,
        parameters=parameters or {},
        sets=sets,
        needs=needs,
        takes_s=takes_s,
        at_most_s=at_most_s,
        holds_part=holds_part,
        virtual=virtual,
    )


def query(
    *,
    answers: Answers,
    parameters: Mapping[str, object] | None = None,
    needs: Mapping[str, Value] | None = None,
    takes_s: Seconds = 0.0,
    at_most_s: float | None = None,
    works_on_part: bool = False,
    virtual: Computed | None = None,
) -> Verb:
    """Returns a verb that asks the device a question, such as a camera's verdict on a part.

    `answers`: all possible answers, at least one; all words, or all numbers. Or float, int or
    `Number(lower, upper)` for any such number. A virtual device gives the first one, or that which `virtual`
    returns. The other parameters are those of `Verb`.
    """
    return Verb(
        effect=Effect.QUERY,
        parameters=parameters or {},
        needs=needs,
        takes_s=takes_s,
        at_most_s=at_most_s,
        answers=answers,
        works_on_part=works_on_part,
        virtual=virtual,
    )
