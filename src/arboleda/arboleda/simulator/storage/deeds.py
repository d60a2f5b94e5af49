"""True deeds for a cell's task: where its effector was switched, what was picked and placed."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.messages import Check
from arboleda.model.plant_model import Evidence, Pose
from arboleda.model.task import Order
from arboleda.recipes.storage_layout import StorageLayout
from arboleda.wire.payloads import EffectorGoal, PathGoal

from ..truth.arm import ArmTruth
from ..truth.mobile import MobileTruth
from ..truth.robot import NOWHERE
from .tasks import path_of, station_of

KEPT = 50  # switches of one task


@dataclass(frozen=True, kw_only=True)
class Switch:
    """A change of an effector, at the named poses where its arm stood still.

    `by_others`: somebody else than the plant opened it; `by_command`: the board carried out a command for it;
    `outdated`: it did so for an order of a process that no longer led when that arrived, and that has no
    number by which the board could have refused it; `released`: an operator had it opened; `taken_away`:
    somebody had put the arm elsewhere by hand; `legal`: at the pick-up or palletizing pick or, opened, where
    the part of the cell's last task belongs or at the palletizing place.
    """

    cell: str
    arm: str
    on: bool
    poses: frozenset[str]
    lost_power: bool
    by_others: bool
    by_command: bool
    outdated: bool
    released: bool
    taken_away: bool
    legal: bool


@dataclass(frozen=True, kw_only=True)
class EndedTask:
    """A task that has ended, and the state of things then.

    `robbed`: somebody else opened the effector while it held its part elsewhere than where that belongs;
    `missing`: why the task is not done, even if it is called so; `unprovable`: its mobile's evidence cannot
    show that. `empty_handed`: its arm's board had reported no part before the effector was told to let go.
    `unchecked`: what nobody confirmed, by the plant's own word.
    """

    cell: CellTruth
    task: str
    text: str
    done: bool
    began_at: float
    picks: int
    places: int
    blind: bool
    grips: bool
    robbed: bool
    missing: str | None
    unprovable: bool
    empty_handed: bool
    unchecked: tuple[Check, ...]


class CellTruth:
    """Deeds since the cell's last task began; `task` is None once it has ended.

    `of_others`: it is at, or was last at, a task of another recipe than those of storage. `picks`: parts
    that left a pick-up in the effector; `places`: parts put down where they belong; `puts_down`:
    its effector was opened for one of these in this step.
    """

    def __init__(self, cell: StorageLayout, arm: ArmTruth | None, mobile: MobileTruth | None) -> None:
        self.cell = cell
        self.arm = arm
        self.mobile = mobile
        self.task: str | None = None
        self.of_others = False
        self.order: Order | None = None
        self.began_at = 0.0
        self.released = False  # an operator has the effector opened
        self.switch: Switch | None = None  # of this step
        self.picks = self.places = 0
        self.earlier = (0, 0)  # picks and places of its task in earlier starts of the plant
        self._over: dict[str, tuple[int, int]] = {}  # the same of tasks that have not ended
        self.robbed = False  # somebody else opened the effector on the way
        self.puts_down = False
        self.let_go = False  # the effector was opened where the part belongs
        self._nothing_since: float | None = None  # for how long its board has said that no part is there
        self.blind = False  # nobody could know for some time what its arm does
        self.empty_handed = False  # its effector is on without a part, and its board has said so
        self._lets_go = False  # the effector was told to let go since it was told to grip
        self._switches: list[Switch] = []
        self._heading = self._arrived = False
        self._carries = False  # the arm was told to move since its effector went on

    @property
    def pick(self) -> Pose:
        """The pose at which the part of the last task is gripped."""
        if self.order is None or station_of(self.cell, self.order) is None:
            return self.cell.pickup if self.order is None else self.cell.palletizing.pick
        path = path_of(self.cell, self.order)
        return self.cell.pickup_of(path) if path else self.cell.pickup

    @property
    def pick_poses(self) -> tuple[Pose, ...]:
        """All poses at which a part of the cell may be gripped."""
        return (*self.cell.pickups, self.cell.palletizing.pick)

    @property
    def place(self) -> Pose | None:
        """The pose at which the part of the last task belongs."""
        if self.order is None:
            return None
        return station_of(self.cell, self.order) or self.cell.palletizing.place

    def begin(self, task: str, order: Order, now: float) -> None:
        """Begin to follow a task."""
        self.task, self.order, self.began_at = task, order, now
        self.earlier = self._over.pop(task, (0, 0))
        self.robbed = self.released = self.let_go = self.blind = False
        self.empty_handed = self._lets_go = False
        self._heading = self._arrived = False
        self.picks = self.places = 0
        self._switches = []

    def cut_off(self) -> None:
        """Cut a task off, as the plant died and the next one does not go on with it; a later one may."""
        if self.task is not None:
            picks, places = self.earlier
            self._over[self.task] = (picks + self.picks, places + self.places)
        self.end()

    def tell(self, *, grips: bool) -> None:
        """Take in that the plant tells its effector to grip, or to let go."""
        self._lets_go = not grips
        if grips:
            self.empty_handed = False

    def feel(self, now: float, *, is_there: bool, debounce_s: float) -> None:
        """Take in what the plant hears of a part from the board of its arm; that none is there counts once it
        has been said for `debounce_s`.
        """
        arm = self.arm
        since = now if self._nothing_since is None else self._nothing_since
        self._nothing_since = None if is_there else since
        settled = not is_there and now - since >= debounce_s
        if settled and arm is not None and arm.on and not arm.holding and not self._lets_go:
            self.empty_handed = True

    def end(self, text: str = "", *, done: bool = False, unchecked: tuple[Check, ...] = ()) -> EndedTask:
        """Note that the running task has ended, or that nobody knows of it any more."""
        task, self.task = self.task, None
        of_arm = self._missing_of_arm() if done and self.arm is not None else None
        of_way = self._missing_way() if done and self.arm is not None else None
        return EndedTask(
            cell=self,
            task=task or "",
            text=text,
            done=done,
            began_at=self.began_at,
            picks=self.picks,
            places=self.places,
            blind=self.blind,
            grips=self.arm is not None and self.arm.on,
            robbed=self.robbed,
            missing=of_arm or of_way,
            unprovable=of_arm is None and self._proves_no_way,
            empty_handed=self.empty_handed,
            unchecked=unchecked,
        )

    def look(self) -> None:
        """Take in what arm and mobile did in this step."""
        self._follow_mobile()
        arm, self.switch, self.puts_down = self.arm, None, False
        if arm is None:
            return
        before, after = _moves_around_switch(arm)
        self._carries = self._carries or before
        if arm.on != arm.was_on:
            self.switch = self._switch(arm)
            self.released = self.released and arm.on
            at_place = self.place is not None and self._at(arm, self.place)
            # if pick and place are one pose, a pick that is tried again also opens the effector there
            self.puts_down = not arm.on and at_place and (self._carries or not self._at(arm, self.pick))
            self.let_go = self.let_go or self.puts_down
            self.robbed = self.robbed or (arm.opened and arm.was_holding and not at_place)
            self._switches = [*self._switches[-KEPT:], self.switch]
            self._carries = False
        self._carries = self._carries or after

    @property
    def _proves_no_way(self) -> bool:
        return self.mobile is not None and self.mobile.robot.evidence is not Evidence.IDS

    def _missing_of_arm(self) -> str | None:
        assert self.arm is not None and self.place is not None and self.order is not None
        due = [self.arm.poses_like(self._due(each).q) for each in self._switches]
        rows = zip(self._switches, due, strict=True)
        done = [(each.on, each.taken_away or bool(each.poses & poses)) for each, poses in rows]
        last = self.cell.home if station_of(self.cell, self.order) else self.place
        if not done or done != [(True, True), (False, True)] * (len(done) // 2):
            switched = ", ".join(f"{'on' if s.on else 'off'} at {named(s.poses)}" for s in self._switches)
            return f"the effector was switched {switched or 'not at all'}"
        ends = [q for q in (last.q, last.above) if q is not None]
        if not (self.arm.taken_away or any(self.arm.stands_at(q) for q in ends)):
            return f"the arm does not stand at {last.name}"
        return None

    def _missing_way(self) -> str | None:
        path = path_of(self.cell, self.order) if self.order is not None else None
        if path is None or self.mobile is None or self._arrived:
            return None
        return f"the mobile never stood at node {path.nodes[-1]}"

    def legal_to_open(self, arm: ArmTruth) -> bool:
        """True if nothing falls down when the effector opens where the arm stands."""
        places = (*self.pick_poses, self.cell.palletizing.place, self.place)
        return any(self._at(arm, pose) for pose in places if pose is not None)

    def _switch(self, arm: ArmTruth) -> Switch:
        goals = [act.goal for act in arm.acts]
        at_pick = any(self._at(arm, pose) for pose in self.pick_poses)
        return Switch(
            cell=self.cell.name,
            arm=arm.robot.name,
            on=arm.on,
            poses=arm.stood,
            lost_power=arm.lost_power,
            by_others=arm.opened,
            by_command=any(isinstance(goal, EffectorGoal) and goal.on == arm.on for goal in goals),
            outdated=arm.switched_by is not None and arm.switched_by.outdated,
            released=self.released,
            taken_away=arm.taken_away,
            legal=at_pick if arm.on else self.legal_to_open(arm),
        )

    def _due(self, switch: Switch) -> Pose:
        """The pose at which a switch belongs: the place for a last one that opens, else the pick-up."""
        last = self._switches and switch is self._switches[-1]
        return self.place if last and not switch.on and self.place else self.pick

    def _at(self, arm: ArmTruth, pose: Pose) -> bool:
        return bool(arm.stood & arm.poses_like(pose.q))

    def _follow_mobile(self) -> None:
        mobile = self.mobile
        if mobile is None or self.task is None or self.order is None:
            return
        path = path_of(self.cell, self.order)
        if path is None:
            return
        end = path.nodes[-1]
        goals = [act.goal for act in mobile.acts if isinstance(act.goal, PathGoal)]
        self._heading = self._heading or any(goal.nodes[-1] == end for goal in goals)
        here = mobile.stands_at(end)
        self._arrived = self._arrived or (self._heading and here)


def _moves_around_switch(arm: ArmTruth) -> tuple[bool, bool]:
    """Two flags: a move was told before, and after, the last switch of its effector in this step."""
    switches = [number for number, act in enumerate(arm.acts) if isinstance(act.goal, EffectorGoal)]
    at = switches[-1] if switches else len(arm.acts)
    return any(act.moves for act in arm.acts[:at]), any(act.moves for act in arm.acts[at:])


def named(poses: frozenset[str]) -> str:
    """Names of poses, for people."""
    return "/".join(sorted(poses)) if poses != NOWHERE else "no pose"
