"""Advisor: the acts that lead a cell out of its present state, by the cell, its robots and the zones.

It keeps nothing: advice is worked out anew from what the plant believes, so it is never of an earlier state.
Advice may be refused as yet, where an act before it in the list makes it possible. A cell may have to wait
for another one that waits for it: `visited` ends that circle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

from arboleda.dispatch.belief import stands_while_cleared
from arboleda.dispatch.obstacles import MAY_LET_GO, Make
from arboleda.model.advice import Advice, Hand
from arboleda.model.cell_states import CellState
from arboleda.model.facts import Facts, Value, shown
from arboleda.model.messages import OperatorRequest, Reason, Verb
from arboleda.model.plant_model import Robot, is_homed_by_word
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.verbs import WORK, Arguments
from arboleda.trees import part_places

from . import reasons
from .cell import CellRun
from .cell_steps import CLEAR_UNCONFIRMED, waits_for_grip
from .plant_state import PlantState
from .verbs.device_verbs import works

WILL_BE_HOMED = Phrase("cell.will_be_homed", "{arm} will have been homed")
IN_THE_WAY = Phrase("advice.in_the_way", "{device} does not say {facts}")
NOT_SAID = Phrase("advice.not_said", "{device} does not say its {fact}")
HOLDS_ZONES = Phrase("advice.holds_zones", "{arm} holds zone {zones}")
MAY_BE_IN = Phrase("zone.may_be_in", "{arm} may still be in {zone}, which is quarantined")
Refusal = Callable[[OperatorRequest], "Sentence | None"]


class Advisor:
    """Finds the ways out of every cell, from the present state alone."""

    def __init__(self, state: PlantState, refusal: Refusal) -> None:
        self._state = state
        self._refusal = refusal
        self._runs: dict[str, list[CellRun]] = {}
        for run in state.cells.values():
            for robot in run.cell.robots:
                self._runs.setdefault(robot.name, []).append(run)

    def advice(self, cell: str) -> tuple[Advice, ...]:
        """The ways out of a cell, each with why it would be refused now."""
        return tuple(replace(each, refusal=self._refused(each)) for each in self.ways_out(cell))

    def ways_out(self, cell: str, visited: frozenset[str] = frozenset()) -> tuple[Advice, ...]:
        """The advice in the order to follow it; none where the cell works, or will go on by itself.

        `visited` are the cells that wait for zones of this cell.
        """
        run = self._state.cells[cell]
        lead = LEADS.get(run.state)
        if lead is None or run.closed or run.manual.teaching is not None:
            return ()
        return tuple(dict.fromkeys(lead(self, run, visited | {cell})))

    def _refused(self, advice: Advice) -> Sentence | None:
        if isinstance(advice.do, Hand):
            return None
        return self._refusal(_request(advice.do, advice.scope, advice.arguments, by_hand=advice.by_hand))

    def _idle(self, run: CellRun, visited: frozenset[str]) -> Iterator[Advice]:
        if run.context.commands.open():
            return
        readying = [*self._readying(run, visited)]
        yield from readying
        if not (readying and readying[0].do is Verb.STOP):
            yield from _mending_books(run)
            yield from _running_again(run)

    def _held(self, run: CellRun, visited: frozenset[str]) -> Iterator[Advice]:
        if run.context.commands.open():
            return
        readying = [*self._readying(run, visited)]
        yield from readying
        if (readying and readying[0].do is Verb.STOP) or (run.awaits and not readying):
            return
        homed = [
            each.scope
            for each in readying
            if each.do is Verb.HOME
            and each.scope in run.cell.workspaces
            and not stands_while_cleared(run.context.robots.belief(each.scope))
            and run.context.devices.has(each.scope)
        ]
        if run.task is None:
            yield from self._recovering(run, visited)
        elif homed:
            yield _abandon(run, WILL_BE_HOMED(arm=homed[0]))
        elif run.stranded:
            yield _abandon(run, run.stranded)
        elif run.awaits and not run.trouble:  # what its devices say decides whether it can go on
            yield replace(_abandon(run, reasons.cause_of_hold(run)), instead=True)
        else:
            verb = Verb.RETRY if run.trouble else Verb.RESUME
            yield Advice(do=verb, scope=run.cell.name, why=reasons.cause_of_hold(run), moves=_movers(run))
            yield replace(_abandon(run, reasons.cause_of_hold(run)), instead=True)

    def _recovering(self, run: CellRun, visited: frozenset[str]) -> Iterator[Advice]:
        name, holding, why = run.cell.name, run.context.parts.holding, reasons.cause_of_hold(run)
        yield from self._freeing(run, run.context.zones.awaited_by_recovery(), visited)
        retry = Advice(do=Verb.RETRY, scope=name, why=why, moves=_recovered(run))
        beside = _held_beside(run)
        for device in beside:
            yield from _releasing(run, device, why)
        helps, failed = not holding or _can_bring_back(run), (Verb.RETRY, name) in run.in_vain
        if helps and not failed:
            yield retry
        for number, robot in enumerate(each for each in holding if each not in beside):
            yield from _releasing(run, robot, why, instead=helps and not failed and number == 0)
        if holding and waits_for_grip(run):
            yield from _running_again(run)
        else:
            yield Advice(
                do=Verb.ABANDON,
                scope=name,
                why=why,
                instead=not holding and not failed,
            )
        if helps and failed:
            yield replace(retry, instead=True)

    def _aborted(self, run: CellRun, visited: frozenset[str]) -> Iterator[Advice]:
        name = run.cell.name
        readying = [*self._readying(run, visited)]
        yield from (each for each in readying if each.do is Hand.REPAIR)  # what is in fault is not still
        yield Advice(do=Verb.CLEAR, scope=name, why=reasons.cause_of_stop(run))
        yield from self._stopped(run, visited)

    def _clearing_stop(self, run: CellRun, visited: frozenset[str]) -> Iterator[Advice]:
        """Advice to clear a cell again; none before its robots had the time to leave their stop."""
        latched = run.context.robots.latched()
        if not latched or run.context.time.now < run.stop_by:
            return
        yield from (each for each in self._readying(run, visited) if each.do is Hand.REPAIR)
        yield Advice(do=Verb.CLEAR, scope=run.cell.name, why=CLEAR_UNCONFIRMED(robots=tuple(latched)))

    def _stopped(self, run: CellRun, visited: frozenset[str]) -> Iterator[Advice]:
        yield Advice(do=Verb.RESET, scope=run.cell.name, why=reasons.cause_of_stop(run))
        yield from self._readying(run, visited)
        for device in (beside := _held_beside(run)):
            yield from _releasing(run, device, reasons.cause_of_stop(run))
        failed = (Verb.RETRY, run.cell.name) in run.in_vain
        if run.context.parts.holding and _can_bring_back(run) and not failed:
            yield Advice(
                do=Verb.RETRY, scope=run.cell.name, why=reasons.cause_of_stop(run), moves=_recovered(run)
            )
        elif run.context.parts.holding:
            for robot in [each for each in run.context.parts.holding if each not in beside]:
                yield from _releasing(run, robot, reasons.cause_of_stop(run))
        yield from _running_again(run)

    def _readying(self, run: CellRun, visited: frozenset[str]) -> Iterator[Advice]:
        """Advice for robots that cannot work yet: a stop first, as it ends what is under way."""
        by_reason: list[Advice] = []
        robots = run.context.robots
        obstacle_of = robots.obstacle if run.state in AT_HAND else robots.obstacle_besides_stop
        for robot in run.cell.reached:
            obstacle = obstacle_of(robot.name)
            if obstacle is None:
                by_reason += _making_known(run, robot) if run.state in AT_HAND else ()
                continue
            if obstacle.reason is Reason.STOPPED and (others := self._stoppers(run, robot.name)):
                for other in others:
                    by_reason += _until_it_moves(self.ways_out(other, visited))
                continue
            is_hearsay = obstacle.reason in HEARSAY and robots.belief(robot.name).is_hearsay
            if is_hearsay and not robot.homes and run.state not in AT_HAND:
                continue  # the stop that is to be cleared ends it
            if obstacle.reason is Reason.STOPPED or (is_hearsay and not robot.homes):
                yield from _stopping(run, obstacle.sentence)
                return
            if _is_cleared_by_homing(run, robot.name):
                by_reason += self._clearing(run, robot.name, obstacle.sentence, visited)
            elif is_hearsay:
                by_reason += self._homing(run, robot.name, obstacle.sentence, visited)
            elif obstacle.reason in HANDS:
                by_reason.append(Advice(do=HANDS[obstacle.reason], scope=robot.name, why=obstacle.sentence))
            elif obstacle.reason is Reason.NOT_HOMED:
                by_reason += self._homing(run, robot.name, obstacle.sentence, visited)
        astray = run.context.zones.astray() if run.state is CellState.IDLE else None
        if astray is not None and not any(each.scope == astray[0] for each in by_reason):
            by_reason += self._homing(run, astray[0], astray[1].sentence, visited)
        yield from by_reason

    def _stoppers(self, run: CellRun, device: str) -> list[str]:
        """The other cells whose stop keeps a shared device stopped; none where this cell's own stop does."""
        runs = self._runs[device]
        if run.state in STOPPING or not run.context.devices.is_stopped(device):
            return []
        return [other.cell.name for other in runs if other.state in STOPPING]

    def _clearing(self, run: CellRun, robot: str, why: Sentence, visited: frozenset[str]) -> Iterator[Advice]:
        """Advice to home a robot out of its fault."""
        if stands_while_cleared(run.context.robots.belief(robot)):
            yield Advice(do=Verb.HOME, scope=robot, why=why)
        else:
            yield from self._homing(run, robot, why, visited)

    def _homing(self, run: CellRun, robot: str, why: Sentence, visited: frozenset[str]) -> Iterator[Advice]:
        by_routine = run.context.robots.homes_by_routine(robot)
        if by_routine:
            yield from _letting_go(run, robot)
            cells = [each.cell for each in self._runs[robot] if robot in each.cell.workspaces]
            zones = frozenset[str]().union(*(cell.workspaces[robot].zones for cell in cells))
            awaited = run.context.zones.awaited(robot, zones)
            machines = {each for cell in cells for each in cell.interlocked}.intersection(awaited.values())
            if any(run.context.robots.belief(each).moves for each in machines):
                return  # a machine at work comes to its end
            yield from self._freeing(run, awaited, visited)
            yield from _running_home(run, robot, why)
            return
        belief = run.context.robots.belief(robot)
        is_claim = is_homed_by_word(belief.robot)
        if (Verb.HOME, robot) in run.in_vain if is_claim else belief.says_unhomed:
            yield Advice(do=Hand.REFERENCE, scope=robot, why=why)
            if not (is_claim or belief.displaced):
                return
        yield Advice(do=Verb.HOME, scope=robot, why=why, by_hand=True)

    def _freeing(self, run: CellRun, zones: Mapping[str, str], visited: frozenset[str]) -> Iterator[Advice]:
        """Acts by which robots give zones back, by the advice of their cells.

        Where two cells wait for each other, or a robot is not heard, a person may answer for an empty zone.
        """
        for holder in sorted(set(zones.values())):
            its = [zone for zone in sorted(zones) if zones[zone] == holder]
            if holder not in self._runs:  # kept from a start whose plant file had it
                yield from self._overriding(its, holder, instead=False)
                continue
            other = self._run_of(holder)
            if other.state is CellState.EXECUTE and holder in other.cell.shared:
                continue  # nobody moves it while a task of another cell uses it
            locks = other.context.zones.interlocks
            stops = other is not run and other.state in STOPPING and other.cell.name not in visited
            if not stops and (facts := locks.unreported(holder, its)) is not None:
                if run.context.zones.awaited(holder, locks.led_into(holder, its)):
                    continue  # in that zone it would meet another robot
                yield from _out_of_the_way(other, holder, facts)
                continue
            why = HOLDS_ZONES(arm=holder, zones=tuple(its))
            if other is run and _can_leave(run, holder):
                yield from _letting_go(run, holder)
                yield from _running_home(run, holder, why)
                continue
            if other is run and _can_be_taken_home(run, holder):
                yield from self._homing(run, holder, why, visited)
                continue
            waits_too = other.cell.name in visited
            leads = () if waits_too else self.ways_out(other.cell.name, visited)
            by_hand = bool(leads) and leads[0].do in HANDS.values()
            yield from leads[:1] if by_hand else _until_it_moves(leads)
            if waits_too or by_hand:
                silent = [zone for zone in its if run.context.zones.is_quarantined(zone)]
                yield from self._overriding(silent, holder, instead=by_hand)

    def _run_of(self, robot: str) -> CellRun:
        """The cell of a robot; of a shared device the cell that holds it, else the first."""
        runs = self._runs[robot]
        return next((run for run in runs if run.context.devices.holds(robot)), runs[0])

    def _overriding(self, zones: Sequence[str], holder: str, *, instead: bool) -> Iterator[Advice]:
        for zone in zones:
            why = MAY_BE_IN(arm=holder, zone=zone)
            yield Advice(do=Hand.CHECK, scope=zone, why=why, instead=instead)
            if self._refusal(_request(Verb.OVERRIDE, zone)) is not None:
                yield Advice(do=Verb.STOP, scope=self._run_of(holder).cell.name, why=why)
            yield Advice(do=Verb.OVERRIDE, scope=zone, why=why)
            instead = False


def _request(verb: Verb, scope: str, arguments: Arguments = (), *, by_hand: bool = False) -> OperatorRequest:
    return OperatorRequest(at=0.0, verb=verb, scope=scope, by_hand=by_hand, arguments=arguments)


def _letting_go(run: CellRun, robot: str) -> Iterator[Advice]:
    """Advice to release a tool that may open late, for which its robot takes no move."""
    tool = run.context.parts.opening_tool(robot)
    if tool is not None:
        why = MAY_LET_GO(robot=robot, tool=tool)
        yield from _releasing(run, tool, why)


def _releasing(run: CellRun, robot: str, why: Sentence, *, instead: bool = False) -> Iterator[Advice]:
    """Advice to have a robot let go of its part, or to take the part out by hand.

    By hand comes first where the robot failed to let go, or a precondition keeps it from opening. It is the
    alternative where the robot cannot be told to.
    """
    release = Advice(do=Verb.RELEASE, scope=robot, why=why, drops=(robot,), instead=instead)
    by_hand = Advice(do=Verb.RELEASE, scope=robot, why=why, by_hand=True, instead=instead)
    obstacle = run.context.parts.obstacle_to_opening(robot)
    unmet = obstacle is not None and obstacle.reason is Reason.PRECONDITION
    if unmet or (Verb.RELEASE, robot) in run.in_vain:
        yield by_hand
        yield replace(release, instead=True)
        return
    yield release
    if obstacle is not None and obstacle.reason in AT_THE_DEVICE:
        yield replace(by_hand, instead=True)


def _running_home(run: CellRun, robot: str, why: Sentence) -> Iterator[Advice]:
    """Advice to home a robot by its routine, or first at its own controls where the routine has failed."""
    failed = (Verb.HOME, robot) in run.in_vain
    if failed:
        yield Advice(do=Hand.REFERENCE, scope=robot, why=why)
    yield Advice(do=Verb.HOME, scope=robot, why=why, moves=(robot,), instead=failed)


def _is_cleared_by_homing(run: CellRun, robot: str) -> bool:
    """True where homing leads a robot out of its fault, and has not failed yet."""
    failed = (Verb.HOME, robot) in run.in_vain
    return not failed and run.context.robots.belief(robot).is_cleared_by_homing


def _out_of_the_way(run: CellRun, device: str, wanted: Facts) -> Iterator[Advice]:
    """Advice by which a device comes to report `wanted`, and so leaves a zone: its own verbs, else by hand.

    A part that it grips is released.
    """
    why = IN_THE_WAY(device=device, facts=tuple(f"{name} {shown(value)}" for name, value in wanted))
    robot, verbs = run.context.robots.belief(device).robot, []
    for fact in wanted:
        if fact == (robot.held_fact, False):
            yield from _releasing(run, device, why)
        elif (words := _words_for(run, robot, fact)) is not None:
            verbs.append(words)
        else:
            yield Advice(do=Hand.FREE, scope=device, why=why)
            return
    for words in verbs:
        yield Advice(do=Verb.DO, scope=device, arguments=((WORK.name, words),), why=why, moves=(device,))


def _making_known(run: CellRun, robot: Robot) -> Iterator[Advice]:
    """Advice to have a robot do what sets a fact that it does not say, and that a verb needs.

    Each of its verbs that sets the fact is an alternative.
    """
    belief = run.context.robots.belief(robot.name)
    unsaid = {name for name in robot.fact_names if belief.fact(name) is None}
    if not unsaid:
        return
    needed = {name for make in robot.calls.values() for name, _ in make(id="").needs}
    needed |= {need.fact for need in run.cell.needs if need.other == robot.name}
    for fact in sorted(unsaid & needed):
        setting = ((words, make) for words, make in works(robot) if fact in dict(make(id="").sets))
        verbs = {make(id="").word: words for words, make in setting if _is_fit(run, make)}
        why = NOT_SAID(device=robot.name, fact=fact)
        for number, words in enumerate(verbs.values()):
            told = ((WORK.name, words),)
            moves, instead = (robot.name,), number > 0
            yield Advice(do=Verb.DO, scope=robot.name, arguments=told, why=why, moves=moves, instead=instead)


def _is_fit(run: CellRun, make: Make) -> bool:
    """True for a command of which every need is met."""
    failure = run.context.commands.objection(make)
    return failure is None or failure.reason is not Reason.PRECONDITION


def _words_for(run: CellRun, robot: Robot, fact: tuple[str, Value]) -> str | None:
    """The words of a verb that sets a fact; None where the device has none, or cannot do it as it stands."""
    if run.state is CellState.EXECUTE or (Verb.DO, robot.name) in run.in_vain:
        return None
    for words, make in works(robot):
        if fact in make(id="").sets and _is_fit(run, make):
            return words
    return None


def _can_leave(run: CellRun, robot: str) -> bool:
    """True for a robot that can be homed out of its zones, in a cell that only stands there."""
    space, robots = run.cell.workspaces.get(robot), run.context.robots
    ready = space is not None and robots.obstacle(robot) is None and robots.homes_by_routine(robot)
    return ready and space is not None and not run.context.zones.awaited(robot, space.zones)


def _can_be_taken_home(run: CellRun, robot: str) -> bool:
    """True for a robot that only a person homes, in a cell that only stands there."""
    robots = run.context.robots
    by_hand = robot in run.cell.workspaces and not robots.homes_by_routine(robot)
    return by_hand and robots.obstacle(robot) is None


def _until_it_moves(advices: Sequence[Advice]) -> Iterator[Advice]:
    """Up to and including the first verb that is for a robot or its cell, not for a zone."""
    for each in advices:
        yield each
        if isinstance(each.do, Verb) and each.do is not Verb.OVERRIDE:
            return


def _stopping(run: CellRun, why: Sentence) -> Iterator[Advice]:
    """Advice where somebody else stopped a robot: the plant stops it too, as its own stop can be cleared."""
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET):
        yield Advice(do=verb, scope=run.cell.name, why=why)


def _abandon(run: CellRun, why: Sentence) -> Advice:
    return Advice(do=Verb.ABANDON, scope=run.cell.name, why=why, moves=_recovered(run))


def _running_again(run: CellRun) -> Iterator[Advice]:
    if run.queue.paused:
        moves = _movers(run) if run.queue else ()
        yield Advice(do=Verb.RESUME, scope=run.cell.name, why=run.queue.why_paused, moves=moves)


def _mending_books(run: CellRun) -> Iterator[Advice]:
    """Advice to say what is at places in question, then to mend the place for which the last task failed."""
    name, places, trouble = run.cell.name, run.context.places, run.context.places.asked.trouble
    for place in places.asked.targets:
        why = part_places.ASKED(place=place)
        yield Advice(do=Hand.TAKE_OUT, scope=f"{name} {place}", why=why)
        if not places.asked.is_output(place):
            yield Advice(do=Hand.LEAVE_IN, scope=f"{name} {place}", why=why, instead=True)
    if trouble is None or trouble.values["place"] in places.asked.targets:
        return
    if places.is_so_still(trouble):
        hand = Hand.TAKE_OUT if trouble.key == part_places.FULL.key else Hand.PUT_IN
        yield Advice(do=hand, scope=f"{run.cell.name} {trouble.values['place']}", why=trouble)


def _held_beside(run: CellRun) -> list[str]:
    """The devices that hold the same part as a hand: no recovery carries it off before they let go."""
    beside = map(run.context.places.held_beside, run.cell.workspaces)
    return [*dict.fromkeys(place.device for place in beside if place and place.device)]


def _can_bring_back(run: CellRun) -> bool:
    """True where a robot's own hand may hold a part, and a recovery knows where the part belongs.

    No recovery empties a clamp on a bench, or the hand of a robot whose part came from an unknown place.
    """
    context, spaces = run.context, run.cell.workspaces
    carriers = [name for name, space in spaces.items() if space.hand.name in context.parts.holding]
    return any(context.parts.way_back(name) is not None for name in carriers)


def _recovered(run: CellRun) -> tuple[str, ...]:
    """The robots that a recovery moves."""
    return tuple(filter(run.context.devices.has, run.cell.workspaces))


def _movers(run: CellRun) -> tuple[str, ...]:
    return tuple(robot.name for robot in run.cell.reached if not robot.is_person)


STOPPING = (CellState.ABORTING, CellState.ABORTED, CellState.CLEARING, CellState.STOPPED)
AT_THE_DEVICE = (Reason.LINK_LOST, Reason.DEVICE_FAULT, Reason.NOT_HOMED)  # the device takes no command
AT_HAND = (CellState.IDLE, CellState.HELD)  # a robot that is stopped then was stopped by somebody else
HANDS: dict[Reason, Hand] = {Reason.LINK_LOST: Hand.BRING_BACK, Reason.DEVICE_FAULT: Hand.REPAIR}
HEARSAY = (Reason.DEVICE_FAULT, Reason.NOT_HOMED)  # that others may have said, and a person can deny
Lead = Callable[[Advisor, CellRun, "frozenset[str]"], Iterator[Advice]]
LEADS: dict[CellState, Lead] = {
    CellState.IDLE: Advisor._idle,
    CellState.HELD: Advisor._held,
    CellState.ABORTED: Advisor._aborted,
    CellState.CLEARING: Advisor._clearing_stop,
    CellState.STOPPED: Advisor._stopped,
}
