"""Bugs of the engine: what reports prove, who holds a zone, what an effector holds."""

from __future__ import annotations

from .engine_bug import bug

EVIDENCE, ZONES, BELIEF = "dispatch/evidence.py", "dispatch/zones.py", "dispatch/belief.py"
STILLNESS = "dispatch/stillness.py"
DISPATCHER, EFFECTORS, LEDGER = "dispatch/dispatcher.py", "dispatch/effectors.py", "dispatch/ledger.py"
OBSTACLES, LATCHES, BOOKING = "dispatch/obstacles.py", "dispatch/latches.py", "dispatch/booking.py"
LIMITS, WHEREABOUTS = "dispatch/time_limits.py", "dispatch/whereabouts.py"
UNDERWAY = "dispatch/underway.py"

OF_EVIDENCE = (
    bug(
        EVIDENCE,
        "A report from before a command proves it.",
        "if broken is not None or report.at < entry.sent_at:",
        "if broken is not None:",
    ),
    bug(
        EVIDENCE,
        "The goal of a command with two facts is reached with one of them.",
        "        if belief.fact(name) != value:\n            return False\n",
        "        if belief.fact(name) == value:\n            break\n"
        "    else:\n        if entry.sets:\n            return False\n",
    ),
    bug(
        EVIDENCE,
        "A way counts as driven at its last node but one.",
        "observed.passed == len(entry.positions) - 1",
        "observed.passed >= len(entry.positions) - 2",
    ),
    bug(
        EVIDENCE,
        "The boot of a board is not compared.",
        "evidence is Evidence.IDS or (evidence is Evidence.JOINTS and before.epoch == report.epoch)",
        "evidence is Evidence.JOINTS and before.epoch == report.epoch",
    ),
    bug(
        EVIDENCE,
        "Another start of the bridge counts as a boot of a board that counts none.",
        " or (evidence is Evidence.JOINTS and before.epoch == report.epoch)",
        " or evidence is Evidence.JOINTS",
    ),
    bug(
        EVIDENCE,
        "Whose joints jump has not rebooted.",
        "    jumped = belief.robot.evidence is Evidence.JOINTS and _jumped(before, belief, report)\n",
        "    jumped = False\n",
    ),
    bug(
        EVIDENCE,
        "A refused command stays open.",
        "        verdict = _refused(entry, report)\n",
        "        verdict = None\n",
    ),
    bug(
        EVIDENCE,
        "That a device gave up is not read.",
        "        verdict = _gave_up(entry, report)\n",
        "        verdict = None\n",
    ),
    bug(
        EVIDENCE,
        "Whoever says nothing of a fact has reached it.",
        "    if reported is None:\n"
        "        return _failed(entry, Reason.NOT_REACHED, FACT_UNSAID, fact=name)\n",
        "    if reported is None:\n        return CommandVerdict(feed=Feed.DONE)\n",
    ),
    bug(
        EVIDENCE,
        "Off its target counts as done.",
        "return _off_target(entry, belief) if _elsewhere(entry, belief) else CommandVerdict(feed=Feed.DONE)",
        "return CommandVerdict(feed=Feed.DONE)",
    ),
    bug(
        EVIDENCE,
        "At joints a robot that rests a while somewhere else goes on waiting.",
        "        elif _stays_short(entry, belief, report.at):\n            return _short(entry)\n    return",
        "    return",
    ),
    bug(
        EVIDENCE,
        "At joints a process is done by its facts, though nobody saw it at work.",
        "    if observed.moving and observed.stopped_since is not None:\n        if not entry.sets",
        "    if observed.stopped_since is not None:\n        if not entry.sets",
    ),
    bug(
        EVIDENCE,
        "At state a halted move counts as done.",
        "if entry.observations.moving and _rests(entry, report) and entry.cancelled_at is None:",
        "if entry.observations.moving and _rests(entry, report):",
    ),
    bug(
        EVIDENCE,
        "A switch is confirmed by any of its facts.",
        "        if report.fact(name) != value:\n            return None\n",
        "        if report.fact(name) == value:\n            break\n    else:\n        return None\n",
    ),
    bug(
        EVIDENCE,
        "The answer to an earlier question counts.",
        "if report.answered == entry.command.id and report.answer is not None:",
        "if report.answer is not None:",
    ),
    bug(
        EVIDENCE,
        "Homing is done as soon as the board says homed.",
        "if entry.observations.unhomed and report.homed and report.state is MotionState.STOPPED:",
        "if report.homed and report.state is MotionState.STOPPED:",
    ),
    bug(
        EVIDENCE,
        "A fault of a device fails nothing.",
        "    if report.state is MotionState.FAULT:\n        if isinstance(entry",
        "    if report.state is MotionState.FAULT and entry.finishes:\n        if isinstance(entry",
    ),
    bug(
        EVIDENCE,
        "Work that a stop has finished is taken for halted.",
        "    stopping = entry.state is State.CANCELLING or entry.finishes\n",
        "    stopping = entry.state is State.CANCELLING\n",
    ),
    bug(
        EVIDENCE,
        "A halt is confirmed by what was said before it.",
        "if belief.stillness.still_since(entry.cancelled_after) else None",
        "if belief.stillness.is_still else None",
    ),
)
OF_ZONES = (
    bug(
        ZONES,
        "Who waits for zones does not keep his place.",
        "            taken |= zones\n        return tuple(granted)",
        "        return tuple(granted)",
    ),
    bug(
        ZONES,
        "One zone of several is enough.",
        "if (zones - self.held_by(robot)).isdisjoint(taken):",
        "if not zones <= taken:",
    ),
    bug(
        ZONES,
        "What is quarantined is freed with the rest.",
        "return self._free(self.held_by(robot) - self._quarantined)",
        "return self._free(self.held_by(robot))",
    ),
    bug(
        ZONES,
        "Who gives up waiting lets nobody else in.",
        "        self.queue.leave(robot)\n        return self._grant()",
        "        self.queue.leave(robot)\n        return ()",
    ),
    bug(
        ZONES,
        "Nobody is served when a zone gets free.",
        "        self._robbed &= self.robots\n        return self._grant()",
        "        self._robbed &= self.robots\n        return ()",
    ),
    bug(
        ZONES,
        "A machine takes a zone in which somebody is.",
        "            if self.holder(zone) not in (None, robot):\n                raise",
        "            if self.holder(zone) in self._quarantined:\n                raise",
    ),
    bug(
        ZONES,
        "A shared device that fell silent is free once it is heard.",
        "        if device in self._holders:\n            self._quarantined.add(device)",
        "        self._quarantined.discard(device)",
    ),
    bug(
        ZONES,
        "Zones that were occupied at the end of an earlier start are free.",
        "self._quarantined = set(self._holders)",
        "self._quarantined = set[str]()",
    ),
)
OF_BELIEF = (
    bug(
        STILLNESS,
        "Two still codes before the moment count.",
        "if not self._says_still or self._state_no <= count:",
        "if not self._says_still:",
    ),
    bug(
        STILLNESS,
        "A robot that moves slowly rests.",
        "moved = position != before or not self._rested_from",
        "moved = not self._rested_from",
    ),
    bug(
        BELIEF,
        "Silence never lasts too long.",
        "self.stale_at = report.at + self.stale_after_s if self.supervised else None",
        "self.stale_at = report.at + 100 * self.stale_after_s if self.supervised else None",
    ),
    bug(
        BELIEF,
        "A piece that comes and goes is there at once.",
        "self.piece_since = report.at if report.piece is not self.piece else self.piece_since",
        "self.piece_since = self.piece_since",
    ),
    bug(
        BELIEF,
        "Who is not homed takes commands while it moves.",
        "return _unhomed(self) if self.unhomed and (trouble is None or trouble is MOVING) else trouble",
        "return _unhomed(self) if self.unhomed and trouble is MOVING else trouble",
    ),
    bug(
        BELIEF,
        "A query is sent to who is not heard.",
        "if trouble is None or trouble.reason is not Reason.LINK_LOST:",
        "if True:",
    ),
    bug(
        BELIEF,
        "A fact that changes is not taken over where another one is as before.",
        "if any(self.facts.get(name) != value for name, value in facts):",
        "if all(self.facts.get(name) != value for name, value in facts):",
    ),
)
OF_DISPATCHER = (
    bug(
        OBSTACLES,
        "A query obeys no needs.",
        "return self._beliefs[robot].unreachable(was=was) or self._unmet(command, was=was)",
        "return self._beliefs[robot].unreachable(was=was)",
    ),
    bug(
        OBSTACLES,
        "A need that was never said is met.",
        "            reported = belief.fact(name)\n            if reported != value:",
        "            reported = belief.fact(name)\n            if reported not in (None, value):",
    ),
    bug(
        OBSTACLES,
        "Only the first need is looked at.",
        "        for name, value in command.needs:\n            reported",
        "        for name, value in command.needs[:1]:\n            reported",
    ),
    bug(
        OBSTACLES,
        "No command is met by the need of what is at work.",
        "return any(sets.get(name, value) != value for name, value in work.command.needs)",
        "return False",
    ),
    bug(
        DISPATCHER,
        "A cancelled command is halted, but also one that finishes.",
        "if entry.state is State.CANCELLING or entry.finishes:\n            return",
        "if entry.state is State.CANCELLING:\n            return",
    ),
    bug(
        DISPATCHER,
        "What is cancelled keeps its old deadline.",
        "        entry.deadline = now + self.limits.timings[entry.cell].stop_timeout_s\n"
        "        self.ledger.plan(entry)",
        "        self.ledger.plan(entry)",
    ),
    bug(
        BOOKING,
        "A command that failed by its deadline goes on moving.",
        "if failed and entry.halts and verdict.failure and verdict.failure.reason not in KNOWN_STILL:",
        "if failed and entry.halts and verdict.failure and verdict.failure.reason is Reason.LINK_LOST:",
    ),
    bug(
        LATCHES,
        "A latch is not kept for the next start.",
        "        self._memory.remember(Fact.LATCH, robot, LATCHED)\n",
        "",
    ),
    bug(
        LATCHES,
        "A clear that nobody heard is not said again.",
        "        if not self._beliefs[robot].online:\n            self.unheard.add(robot)\n",
        "",
    ),
    bug(
        WHEREABOUTS,
        "Where a robot stands is told while a command is on its way to it.",
        "restless = belief.state is MotionState.MOVING or given",
        "restless = belief.state is MotionState.MOVING",
    ),
    bug(
        LIMITS,
        "The deadline of a move forgets how far it is.",
        "return max(robot.timeout_s, travel_s * timing.deadline_factor + timing.deadline_floor_s)",
        "return min(robot.timeout_s, timing.deadline_floor_s)",
    ),
    bug(
        LIMITS,
        "A switch of which nothing is told settles at once.",
        "return now + timing.effector_settle_s + command.takes_s",
        "return now + timing.effector_settle_s",
    ),
    bug(
        BOOKING,
        "The grip of a switch that is done is not booked.",
        "self._effectors.set(command.robot, Grip.ON if command.grips else Grip.OFF)",
        "self._effectors.set(command.robot, Grip.ON)",
    ),
    bug(
        DISPATCHER,
        "Silence fails no command.",
        "            self.booking.book(entry, CommandVerdict(feed=Feed.FAILED, failure=failure), now)\n\n\n"
        "def _facts_shown",
        "            entry.interference = failure.sentence\n\n\ndef _facts_shown",
    ),
)
OF_EFFECTORS = (
    bug(
        EFFECTORS,
        "Grips are not kept.",
        "            self._memory.remember(Fact.EFFECTOR, robot, grip._value_)  # a call less than `value`\n",
        "",
    ),
    bug(
        EFFECTORS,
        "The report of an effector counts while it is switched.",
        "if self.grips[robot] is grip or self._switches(robot):\n            return",
        "if self.grips[robot] is grip:\n            return",
    ),
    bug(
        EFFECTORS,
        "What opens unbidden is no news.",
        "if self.grips[arm] is not Grip.ON or self._switches(arm):",
        "if self.grips[arm] is Grip.ON or self._switches(arm):",
    ),
    bug(
        EFFECTORS,
        "Who is emptied by a person still holds a part.",
        "            self._set_emptied(robot, emptied=True)\n"
        "        self.set(robot, Grip.OFF, taken_out=True)",
        "            self._set_emptied(robot, emptied=True)\n        self.set(robot, Grip.OFF)",
    ),
    bug(
        LEDGER,
        "A command that is done while it is cancelled counts as cancelled.",
        "(State.CANCELLING, Feed.DONE): State.DONE,",
        "(State.CANCELLING, Feed.DONE): State.CANCELLED,",
    ),
    bug(
        LEDGER,
        "A cell is not woken by the end of its command.",
        "if after is not entry.state:\n            self.changed.add(entry.cell)",
        "if after is State.RUNNING:\n            self.changed.add(entry.cell)",
    ),
    bug(
        UNDERWAY,
        "A command is settled by the one before it.",
        "            del ids[: ids.index(taken) + 1]",
        "            del ids[: ids.index(taken) + 2]",
    ),
)
DISPATCH_BUGS = (*OF_EVIDENCE, *OF_ZONES, *OF_BELIEF, *OF_DISPATCHER, *OF_EFFECTORS)
