"""Mutants of the plant's operation: proofs, bridge, operators' verbs, advice and screens."""

from __future__ import annotations

from arboleda.core import advisor
from arboleda.core.acts import outcome_of
from arboleda.core.advisor import Advisor
from arboleda.core.operator import Operator
from arboleda.core.people import People
from arboleda.core.readiness import Readiness
from arboleda.core.verbs.held_cells import not_resumable
from arboleda.core.verbs.overriding import Overriding
from arboleda.core.verbs.stops import Stops
from arboleda.dispatch import evidence
from arboleda.dispatch.belief import Belief
from arboleda.dispatch.latches import Latches
from arboleda.oee import figures as oee
from arboleda.recipes.parameters import Slot
from arboleda.trees import steps
from arboleda.trees.zone_needs import ZoneNeeds
from arboleda.views import view
from arboleda.wire import status
from arboleda.wire.board import Board
from arboleda.wire.bridge import Bridge

from .mutant import SHARED, edit, mutant

PROOFS = (
    mutant(
        "proofs_end_commands",
        "A bridge's restart does not fail open commands.",
        edit(evidence._broken_link, "report.epoch != before.epoch", "False"),
        weather={"bridge_restart": 30.0, "hop_partition": 40.0},
        likely=19,
    ),
    mutant(
        "ends_are_proven",
        "Reports made before a command was sent are judged.",
        edit(evidence.judge, " or report.at < entry.sent_at", ""),
        weather={"plant_stall": 60.0, "operator_home": 20.0, "operator_release": 40.0, "operator_stop": 10.0},
        likely=9,
    ),
)

BRIDGE = (
    mutant(
        "telemetry_is_reported",
        "Retained telemetry that repeats the last is believed.",
        edit(Board._again, " or delivery.retain", ""),
        weather={"foreign_repeat": 40.0},
    ),
    mutant(
        "commands_are_passed_on",
        "A clear of an old plant passes the fence.",
        edit(Bridge._fence, "if is_stop(command):", "if isinstance(command, Stop):"),
        weather={"second_orchestrator": 60.0},
    ),
    mutant(
        "who_moves_hears_the_beat",
        "Beats go to boards that need not move.",
        edit(Bridge._beat_all, " if board.in_motion", ""),
        weather="none",
    ),
)

PEOPLE = (
    mutant(
        "tasks_start_where_all_is_ready",
        "A task starts whatever its robots say.",
        edit(
            Readiness.objection,
            "failures = [self._context.robots.obstacle(robot.name) for robot in self._cell.reached]",
            "failures = []",
        ),
    ),
    mutant(
        "believed_as_said",
        "That a robot is homed again is not believed.",
        edit(
            Belief.merge,
            "if value is not None:",
            'if value is not None and (name != "homed" or value is False):',
        ),
    ),
    mutant(
        "texts_mean_what_they_say",
        "The last station of a rack is not known.",
        edit(Slot._numbers, "range(len(", "range(-1 + len("),
        weather="none",
    ),
    mutant(
        "tasks_take_their_time",
        "After an effector nobody dwells.",
        edit(
            steps.effector,
            "Dwell(DWELL(), context.time, context.timing.dwell_s)",
            "Dwell(DWELL(), context.time, 0.0)",
        ),
        weather="none",
    ),
    mutant(
        "recovery_takes_its_zones",
        "A recovery from an unknown place is planned as from home.",
        edit(
            ZoneNeeds.for_recovery,
            "self._whereabouts.place(space)",
            "self._robots.standing(robot)",
        ),
        seeds=SHARED,
        weather={"brown_out": 10.0, "operator_override": 20.0, "operator_retry": 20.0, "lost_steps": 10.0},
        likely=70,
    ),
    mutant(
        "verbs_are_refused_rightly",
        "A cell whose queue runs can be resumed.",
        edit(not_resumable, "None if cell.queue.paused else", "None if True else"),
        weather={"operator_resume": 40.0},
        likely=12,
    ),
    mutant(
        "acts_end_as_told",
        "What an operator's release could not do is told as done.",
        edit(outcome_of, " if entry.state is not State.DONE", " if entry.open"),
        weather={"operator_release": 60.0, "stuck_effector": 30.0, "operator_stop": 10.0},
    ),
    mutant(
        "verbs_do_what_they_say",
        "To clear one robot clears its cell.",
        edit(
            Stops.clear,
            "if not any(robot.name in stopped for robot in cell.cell.robots):",
            "if True:",
        ),
        weather={"operator_stop": 20.0, "operator_clear": 40.0},
    ),
    mutant(
        "kept_before_it_leaves",
        "A latch is remembered only after it left.",
        edit(
            Latches.latch,
            "self._memory.remember(Fact.LATCH, robot, LATCHED)\n    self._outlet.stop(robot, StopMode.LATCH)",
            "self._outlet.stop(robot, StopMode.LATCH)\n    self._memory.remember(Fact.LATCH, robot, LATCHED)",
        ),
        weather={"operator_stop": 10.0},
    ),
    mutant(
        "kept_is_what_is",
        "An overridden zone is still kept, and so quarantined again after a restart.",
        edit(Overriding._override, "self._state.dispatcher.memory.vacate([zone])", ""),
        seeds=SHARED,
        weather={"brown_out": 15.0, "operator_override": 40.0, "operator_stop": 5.0},
    ),
)

ADVICE = (
    mutant(
        "advice_leads_out",
        "After a reboot it is advised to retry, which is held again, for ever.",
        edit(Advisor._readying, "obstacle.reason is Reason.NOT_HOMED", "False"),
        edit(Advisor._recovering, "(Verb.RETRY, name) in run.in_vain", "False"),
        weather={"reboot": 2.0},  # so seldom that seven acts follow on one
        likely=70,
        cycles=20,
    ),
    mutant(
        "refusals_are_foretold",
        "It is foretold that no verb is refused.",
        edit(Operator.refusal, "return refused.sentence", "return None"),
        weather={"operator_resume": 40.0},
    ),
    mutant(
        "no_advice_where_all_is_well",
        "It is advised to resume a queue that runs.",
        edit(advisor._running_again, "if run.queue.paused:", "if True:"),
        likely=83,
        weather="none",
        rest_s=60.0,
    ),
)

SCREENS = (
    mutant(
        "screens_show_what_is",
        "A screen shows the age of a report as of the start of the plant.",
        edit(view._robot, "now - belief.heard_at", "now"),
        weather="none",
    ),
    mutant(
        "screens_are_told_of_news",
        "What an operator has done is shown only with the next news.",
        edit(People.operate, "self._state.news.changes += 1", "pass"),
        weather={"operator_hold": 10.0},
    ),
    mutant(
        "status_says_the_report",
        "The status has no word of the piece.",
        edit(status.to_status, "if value is not None", 'if value and key != "piece"'),
        weather="none",
    ),
    mutant(
        "plans_show_the_model",
        "A rack is shown with a station too many.",
        edit(view._cell_layout, '"stations": len(cell.stations)', '"stations": len(cell.stations) + 1'),
        weather="none",
    ),
    mutant(
        "oee_is_as_seen",
        "A task counts that was done before the time that is asked for.",
        edit(oee._produced, "since_s <= work.ended_s", "True"),
        weather="none",
        cycles=8,
    ),
)

OPERATION = (*PROOFS, *BRIDGE, *PEOPLE, *ADVICE, *SCREENS)
