"""Mutants for commands and for what goes over the wire."""

from __future__ import annotations

from arboleda.dispatch.belief import Belief
from arboleda.dispatch.booking import Booking
from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.ledger import Ledger
from arboleda.dispatch.obstacles import Obstacles
from arboleda.sim.board import Board as VirtualBoard
from arboleda.sim.freshness import Freshness
from arboleda.sim.receipts import Receipts
from arboleda.trees import steps
from arboleda.trees.leaves import Act
from arboleda.wire import forms, hop, strict
from arboleda.wire.board import Board
from arboleda.wire.bridge import Bridge

from .mutant import edit, mutant

TOLD = "self.outlet.stop(report.robot, "
ASKED = f"{TOLD}StopMode(report.robot in self.latches.stopped))"
RETURNED = (
    "if latched and (new_link or (belief.online and not was_online)):  # its board may have lost the stop"
)

COMMANDS = (
    mutant(
        "no_move_after_its_halt",
        "Each kind of command has a topic of its own over the hop, and a halt overtakes its move.",
        edit(hop.command_topic, 'f"{command.robot}/{COMMAND}"', "plain_topic(command)"),
        weather={"hop_reorder": 20.0, "operator_hold": 40.0, "operator_resume": 40.0},
        cycles=10,
    ),
    mutant(
        "no_command_to_unfit",
        "A robot that is not homed takes any command, not only to home.",
        edit(Obstacles.to, "led_out = isinstance(command, Home) and ", "led_out = "),
        likely=5,
    ),
    mutant(
        "stops_are_cleared_by_operators",
        "A robot that comes back is told whether it is stopped, and so cleared where it is not.",
        edit(
            Dispatcher.report,
            f"{RETURNED}\n        {TOLD}StopMode.LATCH)",
            f"if belief.online and not was_online:\n        {ASKED}",
        ),
    ),
    mutant(
        "one_motion_per_robot",
        "Nobody asks whether the last move has ended, neither who sends nor who recovers.",
        edit(Obstacles.to, "else self._ledger.work_of(robot)", "else None"),
        edit(steps._settle, "return not ending and not any", "return not any"),
        likely=6,
    ),
    mutant(
        "only_legal_command_states",
        "A command that is cancelled leaves the ledger at once.",
        edit(Ledger.feed, "if not entry.open:", "if not entry.open or feed is Feed.CANCEL:"),
    ),
    mutant(
        "no_deadline_overrun",
        "A cancel gives a command more time, instead of the time of a halt.",
        edit(Dispatcher.cancel, "entry.deadline = now +", "entry.deadline +="),
    ),
    mutant(
        "retries_bounded",
        "A step is tried once more than allowed.",
        edit(Act.update, "self.tries < retry.times", "self.tries <= retry.times"),
    ),
    mutant(
        "halted_moves_sent_halt",
        "Halted is what stands still, instead of what may be moving.",
        edit(Booking.book, "not in KNOWN_STILL", "in KNOWN_STILL"),
    ),
)

WIRE = (
    mutant(
        "bridge_obeys_only_its_plant",
        "The bridge obeys whoever commands, while it hears its plant.",
        edit(Bridge._is_commanded, "return at <", "return at < 0 <"),
        weather={"foreign_command": 20.0},
    ),
    mutant(
        "executed_numbers_rise",
        "A board compares the epoch of a command, and not its number.",
        edit(
            Receipts.objection,
            "(goal.epoch, goal.seq) <= (self.epoch, last)",
            "goal.epoch < self.epoch",
        ),
        weather={"foreign_old": 30.0},
    ),
    mutant(
        "no_repeat_has_effect",
        "A board believes what the broker retained.",
        edit(VirtualBoard.receive, "if delivery.retain:", "if False:"),
        weather={"foreign_retained": 20.0, "reboot": 10.0},
    ),
    mutant(
        "nothing_of_an_old_epoch_has_effect",
        "A board says that another bridge has beaten, and obeys the one before.",
        edit(Receipts.objection, "goal.epoch < self.least", "goal.epoch < self.least < 0"),
        weather={"foreign_old": 30.0, "bridge_restart": 15.0},
    ),
    mutant(
        "nothing_late_has_effect",
        "A board takes whatever telemetry a command names for fresh.",
        edit(Freshness.covers, "return first is not None and first <= number", "return number"),
        weather={"partition": 20.0, "delay": 20.0},
    ),
    mutant(
        "commands_say_what_was_heard",
        "A command names the first telemetry that the plant heard of its robot.",
        edit(Belief._hear, "if report.number is not None:", "if self.number is None:"),
        edit(Belief.hear_again, "if report.number is not None:", "if self.number is None:"),
        weather="none",
    ),
    mutant(
        "wire_targets_legal",
        "Joint targets go out as they are, not as motor steps.",
        edit(forms._wire_joints, "robot.motion.quantised(command.q)", "command.q"),
        weather="none",
    ),
    mutant(
        "nothing_retained_on_commands",
        "What must arrive is retained.",
        edit(Board._publication, "qos=qos)", "qos=qos, retain=qos > 0)"),
        weather="none",
    ),
    mutant(
        "payload_size",
        "The whole buffer is sent, with its terminator, instead of what was written.",
        edit(strict.write, "return raw", "return raw.ljust(LIMIT_BYTES + 1)"),
        weather="none",
    ),
    mutant(
        "published_joints_are_reported",
        "Where a robot is on its way is not taken over.",
        edit(
            Belief.merge,
            "if value is not None:",
            'if value is not None and (name != "q" or report.state is not MotionState.MOVING):',
        ),
        weather="none",
    ),
    mutant(
        "nothing_shown_before_heard",
        "An arm counts as at its reference until it is heard.",
        edit(
            Belief.__init__,
            "self.position: Position | None = None",
            "self.position = self.q = robot.reference",
        ),
        weather={"plant_crash": 3.0},
    ),
)

PROTOCOL = (*COMMANDS, *WIRE)
