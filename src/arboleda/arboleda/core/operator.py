"""Verbs of operators: a table of who plans each verb; acts are done, journalled and followed to their end."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.model.advice import DO
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Journal, OperatorRequest, Outcome, Verb
from arboleda.model.outside import quoted
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.verb_scopes import PLANT, scope_of, whole
from arboleda.model.verbs import Arguments, as_text, lasting

from .acts import ENDED, Acts, OperatorAct, outcome_of
from .plant_state import PlantState
from .verbs.answering import Answering
from .verbs.cancelling import Cancelling
from .verbs.cell_by_cell import CellByCell, Doing, Plan
from .verbs.device_verbs import DeviceVerbs
from .verbs.held_cells import (
    abandon,
    hold,
    not_abandonable,
    not_holdable,
    not_resumable,
    not_retryable,
    resume,
    retry,
)
from .verbs.homing import Homing
from .verbs.overriding import Overriding
from .verbs.part_counts import PartCounts
from .verbs.releasing import Releasing
from .verbs.scopes import Scopes, VerbRefusal
from .verbs.stops import Stops, not_resettable
from .verbs.taught_cells import BY_VERB, TEACHING_ENDED, TaughtCells, not_taught

DID = Phrase("did.verb", "{verb}")
DID_BY_HAND = Phrase("did.by_hand", "{verb} by hand")  # only read, in journals
DECLARED_HOMED = Phrase("did.declared_homed", "home {scope} by hand")
DECLARED_EMPTY = Phrase("did.declared_empty", "release {scope} by hand: the part was taken out")
DID_BY_CLIENT = Phrase("did.by_client", "{verb} by its client")
STOPS_SHARED = Phrase(
    "did.stops_shared", "{did}; {devices}, shared with {cells}, stops too and stays so until reset {scope}"
)
NO_ARGUMENT = Phrase("refusal.no_argument", "{verb} takes no argument {argument}")
PUT_TO_WORK = Phrase("act.put_to_work", "version {number} was put to work by {by}: {changes}")
RESTART_WANTED = Phrase("act.restart_wanted", "{by} has the plant restart once all its cells rest")
RESTART_UNWANTED = Phrase("act.restart_unwanted", "{by} does not have the plant restart any more")
CLOCK_AHEAD = Phrase("act.clock_ahead", "the clock of the plant's machine was set {seconds:.0f} s ahead")
CLOCK_BACK = Phrase("act.clock_back", "the clock of the plant's machine was set back by {seconds:.0f} s")
BY_HAND = {Verb.HOME: DECLARED_HOMED, Verb.RELEASE: DECLARED_EMPTY}
"""Sentences on verbs that a person has done by hand."""
ACTS_TOLD = {
    phrase.key: phrase
    for phrase in (
        PUT_TO_WORK,
        RESTART_WANTED,
        RESTART_UNWANTED,
        CLOCK_AHEAD,
        CLOCK_BACK,
        *DO.values(),
        *ENDED.values(),
        *BY_HAND.values(),
        PLANT,
        DID,
        DID_BY_HAND,
        DID_BY_CLIENT,
        TEACHING_ENDED,
    )
}
"""All that is said of what operators did, by key."""


class Operator:
    """Carries out a verb wherever in its scope that can be done; refuses it where it can be done nowhere.

    `table` has for each verb a `CellByCell`, which does it cell by cell, or the function that plans it.
    """

    def __init__(self, state: PlantState, broke: Callable[[str, Exception], None]) -> None:
        self.acts = Acts()
        self.scopes = scopes = Scopes(state)
        self._state = state
        self._doing = doing = Doing(broke)
        stops, counts = Stops(state), PartCounts(state, scopes)
        self.homing = Homing(state, scopes, doing)
        self.table: dict[Verb, CellByCell | Plan] = {
            Verb.STOP: CellByCell(doing, first=stops.latch, do=lambda cell, robots: cell.stop()),
            Verb.CLEAR: CellByCell(
                doing,
                check=stops.not_clearable,
                do=stops.clear,
                must_all=(CellState.ABORTING, CellState.ABORTED, CellState.CLEARING),
            ),
            Verb.RESET: CellByCell(
                doing, check=not_resettable, do=stops.reset, must_all=(CellState.CLEARING,)
            ),
            Verb.HOLD: CellByCell(doing, check=not_holdable, do=hold),
            Verb.RESUME: CellByCell(doing, check=not_resumable, do=resume),
            Verb.CANCEL: Cancelling(state, scopes, doing).plan,
            Verb.RETRY: CellByCell(doing, check=not_retryable, do=retry),
            Verb.ABANDON: CellByCell(doing, check=not_abandonable, do=abandon),
            Verb.RELEASE: Releasing(state, scopes, doing).plan,
            Verb.HOME: self.homing.plan,
            Verb.DO: DeviceVerbs(state, scopes, doing).plan,
            Verb.OVERRIDE: Overriding(state, scopes).plan,
            Verb.UNLOAD: counts.plan_unloading,
            Verb.LOAD: counts.plan_loading,
            Verb.ANSWER: Answering(state).plan,
            Verb.TEACH: TaughtCells(state, scopes, self.acts).plan,
            Verb.AUTOMATIC: CellByCell(
                doing, check=not_taught, do=lambda cell, robots: cell.manual.end(BY_VERB)
            ),
        }

    def act(self, request: OperatorRequest) -> OperatorAct:
        """Do what is asked, and journal it; VerbRefusal says why nothing was done."""
        scope = scope_of(request)
        do = self._planned(request, scope)
        self._doing.begin()
        do()
        outcome, why = self._at_once(request.verb)
        act = OperatorAct(
            number=self.acts.next_number,
            at=self._state.clock.now,
            verb=request.verb,
            scope=scope,
            arguments=arguments_of(request),
            cell=self.scopes.cell_of(request, scope),
            sentence=self._with_shared(request.verb, scope, _did(request, scope)),
            outcome=outcome,
            why=why,
            ended_at=self._state.clock.now if outcome is Outcome.FAILED else None,
        )
        self.acts.add(act, self._doing.sent)
        self._journal(act, act.sentence)
        if outcome is Outcome.FAILED:
            self._journal(act, act.ended, outcome)
        return act

    def look(self) -> bool:
        """Journal the ends of acts that devices carry out; True where one has ended."""
        news = False
        for act, entries in self.acts.ended(self._state.clock.now):
            self._journal(act, act.ended, act.outcome)
            for entry in entries:
                self._state.cells[entry.cell].in_vain.learn(act.verb, entry)
            news = True
        return news

    def refusal(self, request: OperatorRequest) -> Sentence | None:
        """The reason why a request would be refused now; None where it would be done."""
        try:
            self._planned(request, scope_of(request))
        except VerbRefusal as refused:
            return refused.sentence
        return None

    def _planned(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """The function that carries out the request; VerbRefusal says what speaks against it."""
        if request.arguments:
            _require_its_own(request)
        row = self.table[request.verb]
        if not isinstance(row, CellByCell):
            return row(request, scope)
        robots = self.scopes.robots(scope)
        return row.planned(robots, self.scopes.cells_in(request.verb, scope, robots))

    def _at_once(self, verb: Verb) -> tuple[Outcome, Sentence | None]:
        """The outcome of an act in the step in which it is asked."""
        if self._doing.defects:
            return Outcome.FAILED, self._doing.defects[0]
        return (Outcome.SENT, None) if verb.row.stops else outcome_of(self._doing.sent)

    def _journal(self, act: OperatorAct, sentence: Sentence, outcome: Outcome | None = None) -> None:
        entry = Journal(
            verb=act.verb,
            scope=act.scope,
            arguments=act.arguments,
            cell=act.cell,
            sentence=sentence,
            outcome=outcome,
        )
        self._state.dispatcher.outbox.append(entry)

    def _with_shared(self, verb: Verb, scope: str, did: Sentence) -> Sentence:
        """The sentence about an act; of a cell's stop also that its shared devices stop for other cells."""
        cell = self._state.cells.get(scope) if verb.row.stops else None
        if cell is None or not cell.cell.shared:
            return did
        cells_of = self._state.dispatcher.model.cells_of
        others = {other.name: None for name in cell.cell.shared for other in cells_of[name]}
        others.pop(scope)
        return STOPS_SHARED(did=did, devices=cell.cell.shared, cells=tuple(others), scope=scope)


def arguments_of(request: OperatorRequest) -> Arguments:
    """The arguments of a request, in the letters in which people see them."""
    return tuple((name, each.lower() if isinstance(each, str) else each) for name, each in request.arguments)


def _require_its_own(request: OperatorRequest) -> None:
    takes = [each.name for each in request.verb.arguments]
    for name, _ in request.arguments:
        if name not in takes:
            raise VerbRefusal(NO_ARGUMENT(verb=request.verb.value, argument=quoted(name)))


def _did(request: OperatorRequest, scope: str) -> Sentence:
    scope = as_text(request.verb, scope, lasting(request.verb, arguments_of(request)))
    if request.by_hand and request.verb in BY_HAND:
        return BY_HAND[request.verb](scope=whole(scope))
    did = DID_BY_CLIENT if request.client else DID
    return did(verb=DO[request.verb](scope=whole(scope)))
