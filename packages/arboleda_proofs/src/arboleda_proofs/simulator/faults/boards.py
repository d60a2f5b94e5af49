"""Faults of a board: its power, its processor, its drivers, its motors."""

from __future__ import annotations

from arboleda.model.plant_model import PlantModel
from arboleda.rig.network import keeps_its_place
from arboleda.rig.world import World

from . import targets
from .board_site import BoardSite
from .kind import End, Fault, all_alike, board_kind, kind, words
from .shared_effects import hold, stall, trouble

TOO_LATE_S = 10.0


@board_kind(targets=targets.boards, words=words("will", "no will"))
def reboot(world: BoardSite, fault: Fault) -> None:
    """A board loses power and has it back at once, before or after the broker told its last will."""
    if world.is_on(fault.target):
        world.power_off(fault.target, will_after_s=0.0 if fault.word == "will" else TOO_LATE_S)
        world.power_on(fault.target)


@board_kind(targets=targets.boards, seconds=(0.2, 20.0), amount=(0.0, 10.0))
def brown_out(world: BoardSite, fault: Fault) -> End:
    """A board is without power for a while; `amount` is how late the broker tells its last will, s."""
    world.power_off(fault.target, will_after_s=fault.amount)
    return hold(world, "dark", fault.target, lambda: world.power_on(fault.target))


@kind(targets=targets.boards, seconds=(0.2, 10.0))
def mute(world: World, fault: Fault) -> End:
    """Nothing that a board publishes arrives, but that it is there."""
    line = world.broker.clients[fault.target].up
    return trouble(line, lambda message: (0.0,) if keeps_its_place(message) else ())


@board_kind(targets=targets.boards, seconds=(0.005, 15.0))
def board_stall(world: BoardSite, fault: Fault) -> End:
    """A board's processor does nothing for a while; what reaches it waits."""
    return stall(world, fault.target, fault.seconds)


@board_kind(targets=targets.boards, seconds=(0.2, 15.0), weight=0.7)
def driver_alarm(world: BoardSite, fault: Fault) -> End:
    """A motor driver reports an alarm: the board ramps to a stop and moves nothing until it is repaired."""
    name, board = fault.target, world.boards[fault.target]

    def repair() -> None:
        board.repair(_now_us(world))
        world.wake(name)

    board.fail(_now_us(world))
    world.wake(name)
    return hold(world, "alarm", name, repair)


def _joints(model: PlantModel, target: str) -> tuple[str, ...]:
    robot = targets.robot_of(model, target)
    return tuple(f"q{number + 1}" for number in range(len(robot.joints)))


@board_kind(targets=targets.arms, words=_joints, amount=(-50.0, 50.0), weight=0.5, alike=all_alike)
def lost_steps(world: BoardSite, fault: Fault) -> None:
    """An axis slips by `amount` motor steps and nobody notices; only homing finds it again."""
    steps = round(fault.amount) or 1
    targets.arm_body(world, fault.target).motors.lose_steps(int(fault.word[1:]) - 1, steps)


def _now_us(world: BoardSite) -> int:
    return round(world.now * 1e6)


KINDS = (reboot, brown_out, mute, board_stall, driver_alarm, lost_steps)
