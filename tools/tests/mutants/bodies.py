"""Mutants for what bodies truly do: zones, motion, grip and stop."""

from __future__ import annotations

from arboleda.core.cell import CellRun
from arboleda.core.cell_steps import _cleared
from arboleda.dispatch import evidence
from arboleda.dispatch.time_limits import TimeLimits
from arboleda.dispatch.zones import Zones
from arboleda.kinds.joints.motion import JointMotion
from arboleda.recipes import storage
from arboleda.sim.arm import ArmBody
from arboleda.sim.board import Board
from arboleda.sim.motors import Motors
from arboleda.trees import steps
from arboleda.trees.cell_zones import CellZones
from arboleda.trees.failures import Failures
from arboleda.trees.leaves import Piece, TakeZones
from arboleda.trees.parts import Parts

from .mutant import SHARED, edit, mutant

LOOKS_AT_NO_PIECE = (
    edit(Parts.lost, "if robot is None or", "if True or"),
    edit(Piece._seen, " is True", " is not None"),
)

ZONES = (
    mutant(
        "one_robot_per_zone",
        "Who waits for a zone gets it, whoever holds it.",
        edit(Zones._grant, "taken = set(self._holders)", "taken = set()"),
        seeds=SHARED,
    ),
    mutant(
        "zone_released_only_outside",
        "An arm gives its zones back without being seen outside.",
        edit(
            CellZones.leave,
            "held = self._seen_outside(robot, self._zones.held_by(robot))",
            "held = self._zones.held_by(robot)",
        ),
        seeds=SHARED,
        weather={"operator_stop": 10.0},
    ),
    mutant(
        "zone_entered_only_when_held",
        "A leg's zones are taken one pose too late, and nothing guards them.",
        edit(steps.tour, "if leg.start == index]", "if leg.start + 1 == index]"),
        edit(CellZones.objection, "if not missing:", "if missing is not None:"),
        seeds=SHARED,
    ),
    mutant(
        "a_wait_names_its_cause",
        "A robot that waits names who asked before it, not who has the zone.",
        edit(TakeZones._awaited, "if held := self.access.awaited(self.robot, self.zones):", "if held := {}:"),
        seeds=SHARED,
    ),
)

MOTION = (
    mutant(
        "no_unhomed_move",
        "A board that boots takes its position for known.",
        edit(Board.reboot, "homed=self._assume_homed", "homed=True"),
    ),
    mutant(
        "no_move_after_a_boot_that_was_told",
        "That a board without ids came back does not count as a boot of it.",
        edit(evidence.displaced, "return jumped or rebooted(before, belief, report)", "return jumped"),
        seeds=SHARED,
        weather={"reboot": 20.0, "brown_out": 10.0},
    ),
    mutant(
        "nothing_moves_unasked",
        "A board that boots homes by itself.",
        edit(Board.reboot, "self.body.reset()", "self.body.reset(); self.body.home(now_us)"),
        likely=6,
    ),
    mutant(
        "arm_stays_within_limits",
        "A board takes an absolute target for a way from where the arm is.",
        edit(
            ArmBody.start,
            "self.motors.steps(tuple(values))",
            "tuple(map(sum, zip(self.motors.position, self.motors.steps(tuple(values)))))",
        ),
    ),
    mutant(
        "done_is_true",
        "An arm counts as there when one of its joints is.",
        edit(
            JointMotion.reached,
            "if not abs(value - goal) <= tolerance:\n            return False\n    return True",
            "if abs(value - goal) <= tolerance:\n            return True\n    return False",
        ),
        seeds=SHARED,
        weather={"plant_stall": 20.0},
        likely=38,
    ),
    mutant(
        "tiny_moves_succeed",
        "A move has the time of its way and not a moment more.",
        edit(
            TimeLimits.allowed_s,
            "max(robot.timeout_s, travel_s * timing.deadline_factor + timing.deadline_floor_s)",
            "travel_s * timing.deadline_factor",
        ),
        weather="none",
    ),
)

GRIPS = (
    mutant(
        "effector_on_only_for_a_part",
        "The work at a pose is done before the arm goes there, and no piece is looked for.",
        edit(steps._at, "[go, *work]", "[*work, go]"),
        edit(steps.grip, "if not check:", "if True:"),
        edit(steps.let_go, "if not check:", "if True:"),
        weather="none",
    ),
    mutant(
        "effector_off_only_where_legal",
        "A recovery opens the effector where the arm is, instead of carrying the part back.",
        edit(
            steps._part_back,
            "*_at(context, robot, back, off)",
            "off",
        ),
        likely=6,
    ),
    mutant(
        "parts_conserved",
        "An effector that opens keeps its part.",
        edit(ArmBody.switch_effector, "self.holding and on", "self.holding"),
        weather="none",
    ),
    mutant(
        "done_tasks_bring_their_parts",
        "Nobody looks whether an effector opened by itself, or has lost its part.",
        edit(Failures.opened_effector, "if robot is None or", "if True or"),
        *LOOKS_AT_NO_PIECE,
        weather={"opened_effector": 20.0},
    ),
    mutant(
        "unchecked_is_as_said",
        "Where no piece sensor speaks nothing is said of it.",
        edit(Piece._seen, "self.handling.miss(Check.GRIP)", "pass"),
        weather="none",
        seeds=SHARED,
    ),
)


STOP = (
    mutant(
        "latched_board_stays_still",
        "A board that is told to stop and latch only stops.",
        edit(Board._stop, "self.latched = self.latched or latch", ""),
        weather={"operator_stop": 10.0, "loss": 20.0, "partition": 10.0, "lost_queue": 20.0},
    ),
    mutant(
        "stop_holds",
        "A cell that was cleared resets itself.",
        edit(
            _cleared,
            "run.become(Cause.CLEARED)",
            "run.become(Cause.CLEARED); run.become(Cause.RESET); run.become(Cause.READY)",
        ),
        weather={"operator_stop": 10.0},
    ),
    mutant(
        "speed_never_rises_after_stop",
        "A stop leaves out the first axis.",
        edit(Motors.stop, "for axis in self.axes:", "for axis in self.axes[1:]:"),
        likely=10,
    ),
)

BODIES = (*ZONES, *MOTION, *GRIPS, *STOP)
PLANTED_PARTS = (
    mutant(
        "nothing_is_dropped",
        "A board that stops switches all its outputs off.",
        edit(
            ArmBody.stop,
            "self.motors.stop(now_us)",
            "self.motors.stop(now_us); self.switch_effector(False)",
        ),
        likely=10,
    ),
    mutant(
        "parts_are_taken_and_put_where_they_can_be",
        "What is resumed begins anew, instead of where it was held.",
        edit(
            CellRun.go_on,
            "for act in self.run.interrupted():\n        act.send()",
            "self.look(self.run.begin(lambda: self.keeping.make(self.task.order)))",
        ),
        weather={"operator_hold": 30.0},
    ),
    mutant(
        "done_tasks_leave_nothing_behind",
        "A storage task fetches its part twice.",
        edit(
            storage.storage.function,
            "Place(station), HOME",
            "Place(station), Pick(pickup), HOME",
        ),
        weather="none",
    ),
    mutant(
        "recipes_end_as_they_say",
        "A task that failed and was recovered counts as done.",
        edit(CellRun.look, "if failure is not None:", "if failure is not None and not recovered:"),
    ),
    mutant(
        "done_tasks_bring_their_parts",
        "A part that was lost is missed neither on the way nor where it belongs.",
        *LOOKS_AT_NO_PIECE,
        weather={"lost_part": 20.0},
    ),
)
