"""Moments that the robots of a cell saw, and the figures of it."""

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command
from arboleda_bench.moments import Cycle, Moment, cycles, kind, reactions

DRIVE = FollowPath(id="1-1", robot="m1", nodes=(0, 3))
REACH = MoveJoints(id="1-2", robot="a1", q=(0.1, 0.0, 0.0))
GRIP = SetEffector(id="1-3", robot="a1", on=True)
HOME = MoveJoints(id="1-4", robot="a1", q=(0.0, 0.0, 0.0))


def commanded(at: float, command: Command) -> Moment:
    return Moment(at=at, command=command, ended=False)


def ended(at: float, command: Command, *, last: bool = False) -> Moment:
    return Moment(at=at, command=command, ended=True, last=last)


TASK = [
    commanded(1.0, DRIVE),
    ended(2.0, DRIVE),
    commanded(2.25, REACH),
    ended(3.0, REACH),
    commanded(3.5, GRIP),
    commanded(4.0, HOME),
    ended(5.0, HOME, last=True),
]


def test_a_reaction_is_what_lies_between_the_end_of_a_move_and_the_next_command():
    found = reactions(TASK)
    assert [(kind(each), each.seconds) for each in found] == [
        ("mobile to arm", 0.25),
        ("arm to effector", 0.5),
    ]


def test_pauses_that_the_recipe_declares_are_no_reactions():
    assert len(reactions([*TASK, commanded(9.0, DRIVE)])) == 2


def test_a_cycle_is_the_sum_of_its_moves():
    assert cycles(TASK) == [Cycle(ended_at=5.0, moves_s=2.75)]


def test_a_cycle_that_has_not_ended_is_none():
    assert cycles(TASK[:-1]) == []


def test_every_cycle_counts_its_own_moves():
    assert [each.moves_s for each in cycles([*TASK, *TASK])] == [2.75, 2.75]
