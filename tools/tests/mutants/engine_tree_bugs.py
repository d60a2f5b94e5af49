"""Bugs of the engine: leaves, zones and shared devices of a cell, places, the way back into a task."""

from __future__ import annotations

from .engine_bug import bug

LEAVES, STEPS, PLACES = "trees/leaves.py", "trees/steps.py", "trees/part_places.py"
CELL_ZONES, CELL_DEVICES, WALK = "trees/cell_zones.py", "trees/cell_devices.py", "resume/walk_back.py"
TRAIL, INTERLOCKS, ZONE_PLAN = "resume/trail.py", "trees/interlocks.py", "model/zone_plan.py"

OF_LEAVES = (
    bug(
        LEAVES,
        "One try too many of a command.",
        "if failure.reason in RETRYABLE and self.tries < retry.times:",
        "if failure.reason in RETRYABLE and self.tries <= retry.times:",
    ),
    bug(
        LEAVES,
        "A step that is left goes on moving.",
        "        if new_status is Status.INVALID:\n            self._halt()\n",
        "        if new_status is Status.FAILURE:\n            self._halt()\n",
    ),
    bug(
        LEAVES,
        "A command is given again without a pause.",
        "            self.again_at = self.time.now + max(retry.backoff_s, LEAST_S)\n",
        "            self.again_at = self.time.now + LEAST_S\n",
    ),
    bug(
        LEAVES,
        "What guards a command is not asked.",
        "return (self.guard() if self.guard is not None else None) or self.failures.opened_effector()",
        "return self.failures.opened_effector()",
    ),
    bug(
        LEAVES,
        "An effector that opened does not end the step.",
        "return (self.guard() if self.guard is not None else None) or self.failures.opened_effector()",
        "return self.guard() if self.guard is not None else None",
    ),
    bug(
        LEAVES,
        "What waits for zones keeps waiting after it was left.",
        "            self.access.leave(self.robot)\n\n\nclass LeaveZones",
        "            pass\n\n\nclass LeaveZones",
    ),
    bug(
        LEAVES,
        "What waits for devices keeps waiting after it was left.",
        "            self.shared.leave(frozenset())\n",
        "            pass\n",
    ),
    bug(
        LEAVES,
        "A wait ends without its cause.",
        "        failure = self.otherwise()\n        if self.final:\n"
        "            self.failures.add(failure, self)\n",
        "        failure = self.otherwise()\n",
    ),
    bug(
        LEAVES,
        "Zones are those that were needed the first time.",
        "        self.zones = self.needed()\n        if self.zones or self.recovers:",
        "        self.zones = self.zones or self.needed()\n        if self.zones or self.recovers:",
    ),
    bug(
        LEAVES,
        "A dwell counts milliseconds.",
        "        self.until = self.began + self.seconds\n        self.time.wake_at(self.until)\n\n"
        "    def update(self) -> Status:\n        over, self.proven =",
        "        self.until = self.began + self.seconds / 1000\n        self.time.wake_at(self.until)\n\n"
        "    def update(self) -> Status:\n        over, self.proven =",
    ),
    bug(
        STEPS,
        "A robot stays in the zone in which it has worked.",
        "    out = [_move(context, robot, space.home)] if pose.zones else []\n",
        "    out: list[Behaviour] = []\n",
    ),
    bug(
        STEPS,
        "A recovery does not wait until all has come to rest.",
        "        return not ending and not any(context.robots.obstacle(robot) for robot in ours())",
        "        return not ending",
    ),
    bug(
        STEPS,
        "A recovery leaves the part in the hand.",
        "    if space.hand.held_fact is not None:\n        steps += _part_back(",
        "    if space.hand.held_fact is None:\n        steps += _part_back(",
    ),
    bug(
        STEPS,
        "A recovery does not rise first.",
        "    steps = [*_opened(context, robot), *_rise(context, robot)]\n",
        "    steps = [*_opened(context, robot)]\n",
    ),
    bug(
        STEPS,
        "A recovery takes no zones.",
        "    if space.zones:\n        needed = partial(context.zones.needs.for_recovery, robot)\n",
        "    if not space.zones:\n        needed = partial(context.zones.needs.for_recovery, robot)\n",
    ),
    bug(
        STEPS,
        "A robot stays low after its work at a pose.",
        "*work, _move(context, robot, pose, above=True)]",
        "*work]",
    ),
    bug(
        STEPS,
        "One try too few to grip.",
        "for number in range(retry.times + 1)]",
        "for number in range(max(retry.times, 1))]",
    ),
    bug(
        STEPS,
        "A shared device is given back with a part in it.",
        "    empty = [] if devices.isdisjoint(holders) else [Require(EMPTY(), context.failures, kept)]\n",
        "    empty: list[Behaviour] = []\n",
    ),
    bug(
        STEPS,
        "A shared arm is given back wherever it stands.",
        "    return [*empty, *homes, LeaveDevices(",
        "    return [*empty, LeaveDevices(",
    ),
    bug(
        STEPS,
        "The zones between two poses are left out.",
        "return context.zones.needs.between(robot, pose).union(*(leg.zones for leg in legs))",
        "return frozenset[str]().union(*(leg.zones for leg in legs))",
    ),
)
OF_PLACES = (
    bug(
        PLACES,
        "A full place takes one more.",
        "return self.parts(target) < self._places[target].holds",
        "return self.parts(target) <= self._places[target].holds",
    ),
    bug(
        PLACES,
        "An empty place gives a part.",
        "return self.parts(target) > 0",
        "return self.parts(target) >= 0",
    ),
    bug(
        PLACES,
        "A part that was let go of lies nowhere.",
        "                self._move(back, +1, hand)\n",
        "                self._move(back, 0, hand)\n",
    ),
    bug(
        PLACES,
        "A part that was taken lies there, too.",
        "            self._move(here, -1, hand)\n",
        "            self._move(here, 0, hand)\n",
    ),
    bug(
        PLACES,
        "A part that was never gripped is lost.",
        "return None if self.is_sure else self.target\n",
        "return None\n",
    ),
    bug(
        PLACES,
        "What a person takes out of a hand lies where it was taken.",
        "            if handling is HandlingStep.EMPTY:\n                here = self",
        "            if handling:\n                here = self",
    ),
    bug(
        PLACES,
        "The books of places are not kept.",
        '" ".join(words) or None)',
        "None)",
    ),
    bug(
        PLACES,
        "A device works on nothing.",
        "return self._without_part(device) if command.works_on_part else None",
        "return None",
    ),
    bug(
        PLACES,
        "Who holds a part takes another one.",
        "return HOLDS_ONE(robot=hand, place=taken) if taken not in (None, here) else None",
        "return None",
    ),
    bug(
        PLACES,
        "A robot leaves with what a device still holds.",
        "return STILL_HELD(robot=robot, place=place.target, device=place.device)",
        "return None",
    ),
    bug(
        PLACES,
        "Supplies are not filled when a task begins.",
        "self._parts |= self._by_people",
        "pass",
    ),
    bug(
        "trees/parts.py",
        "A part that is lost on the way is carried on.",
        "if robot is None or self._sensors.read(robot, 0.0) is not False:",
        "if robot is None or self._sensors.read(robot, 0.0) is not None:",
    ),
    bug(
        "trees/parts.py",
        "A part goes back to where the robot went last, also where it took none.",
        "if self._cell.reach[robot].hand.name not in self.holding and not given:",
        "if not given:",
    ),
    bug(
        "trees/handling.py",
        "A grip that nobody has confirmed counts as checked.",
        "            if not (holds or belief.robot.has_effector):\n                self.miss(Check.GRIP)\n",
        "            pass\n",
    ),
    bug(
        "trees/piece_sensors.py",
        "A piece counts before it has been there long enough.",
        "        if self._time.now < settled_at:\n",
        "        if self._time.now < settled_at - self._debounce_s:\n",
    ),
)
OF_CELLS = (
    bug(
        CELL_ZONES,
        "A command may lead into a zone that is not held.",
        "        missing = needed - self._zones.held_by(command.robot)\n",
        "        missing = frozenset[str]()\n",
    ),
    bug(
        CELL_ZONES,
        "Zones are given back before the robot is seen outside.",
        "return held if self._dispatcher.whereabouts.place(space) is not None else frozenset()",
        "return held",
    ),
    bug(
        CELL_ZONES,
        "A zone that was given back is kept as taken.",
        "            self._dispatcher.memory.vacate(held)\n"
        "            self._dispatcher.wake(self._zones.robbed)\n",
        "            self._dispatcher.wake(self._zones.robbed)\n",
    ),
    bug(
        CELL_ZONES,
        "Nobody is woken when a zone gets free.",
        "        self._dispatcher.wake(granted)\n        return not self._zones.held_by(robot)",
        "        return not self._zones.held_by(robot)",
    ),
    bug(
        CELL_ZONES,
        "A machine that is in the way takes no zone.",
        "        if free:\n            self._claim(device, free)\n",
        "",
    ),
    bug(
        CELL_ZONES,
        "A machine keeps its zone once it is out of the way.",
        "        if before - occupied:\n            self.leave(device)",
        "        if before < occupied:\n            self.leave(device)",
    ),
    bug(
        INTERLOCKS,
        "A machine that is not heard is out of the way.",
        "            if not belief.online\n            or not belief.stillness.is_sure\n",
        "            if not belief.stillness.is_sure\n",
    ),
    bug(
        INTERLOCKS,
        "What a machine has told before its stop counts.",
        "            or not belief.stillness.is_sure\n",
        "",
    ),
    bug(
        INTERLOCKS,
        "A machine is out of the way while it is on its way there.",
        "            or any(map(each.is_ended_by, may_come))\n",
        "",
    ),
    bug(
        ZONE_PLAN,
        "No node on the way lies in a zone.",
        "    inside = _lying(space, positions[1:] or positions)\n",
        "    inside = _lying(space, positions[-1:])\n",
    ),
    bug(
        ZONE_PLAN,
        "The zones of a crossing are left out.",
        "    return frozenset[str]().union(*named, *(passed(",
        "    return frozenset[str]().union(*(passed(",
    ),
    bug(
        ZONE_PLAN,
        "The way back of a recovery is planned without its zones.",
        "    moves += [(pose, goal) for pose in poses for goal in recovery]\n",
        "",
    ),
    bug(
        CELL_DEVICES,
        "Any cell may command a shared device.",
        "        if holder == name:\n            return None\n        held = NOT_HELD",
        "        if holder != name:\n            return None\n        held = NOT_HELD",
    ),
    bug(
        "trees/hand_over.py",
        "A shared device is given back at work.",
        "return online and not self._works(device) and device not in self._dispatcher.latches.stopped",
        "return online and device not in self._dispatcher.latches.stopped",
    ),
    bug(
        CELL_DEVICES,
        "Who holds a shared device is not kept.",
        "        memory.occupy(devices, name)\n",
        "",
    ),
    bug(
        CELL_DEVICES,
        "A shared device is used before its stop is over.",
        "return self._dispatcher.memory.value(Fact.LATCH, device) is not None",
        "return device in self._dispatcher.latches.stopped",
    ),
    bug(
        CELL_DEVICES,
        "Nobody is woken when a shared device gets free.",
        "        self._dispatcher.wake(granted)\n        return held == quiet",
        "        return held == quiet",
    ),
    bug(
        "trees/needs.py",
        "What another device is about to change counts as it is.",
        "        if self._is_changing(need):\n",
        "        if reported is None and self._is_changing(need):\n",
    ),
    bug(
        "trees/needs.py",
        "Who is not heard meets what another device needs.",
        "        if not self._dispatcher.beliefs[other].online:\n            return SILENT",
        "        if not self._dispatcher.beliefs[other].online and reported is None:\n"
        "            return SILENT",
    ),
    bug(
        "trees/needs.py",
        "Needs of other devices are not asked.",
        "        if reported != need.value:\n            return NEEDS",
        "        if reported == need.value and reported is None:\n            return NEEDS",
    ),
    bug(
        "trees/failures.py",
        "The last cause of a failure counts.",
        "        if self.first is None:\n            self.first, self.leaf = failure, leaf\n",
        "        self.first, self.leaf = failure, leaf\n",
    ),
    bug(
        "trees/cell_time.py",
        "Time passes while a cell is held.",
        "            self.paused_s += self._clock.now - self._paused_at\n",
        "",
    ),
)
OF_WALK_BACK = (
    bug(
        WALK,
        "A boot meanwhile is not compared.",
        "        if belief.boot_id != knowledge.boot:\n            return Doubt",
        "        if False:\n            return Trouble",
    ),
    bug(
        WALK,
        "Commands of which nobody knows are not looked for.",
        "        if not knowledge.explains(belief.receipt):\n",
        "        if False:\n",
    ),
    bug(
        WALK,
        "What was done is not read.",
        '    if last["done"]:\n        return Fate.DONE\n',
        "",
    ),
    bug(
        WALK,
        "A command that was taken counts as done.",
        "    return Fate.DONE if ended and facts_hold and number is not None else Fate.UNPROVEN",
        "    return Fate.DONE",
    ),
    bug(
        WALK,
        "A move that ended anywhere is done.",
        'return Fate.DONE if ended and facts_hold and _at(last["goal"], belief) else Fate.CUT_SHORT',
        "return Fate.DONE if ended else Fate.CUT_SHORT",
    ),
    bug(
        WALK,
        "A part that was lost meanwhile is not missed.",
        "        if grip == Grip.ON and holds is False:\n",
        "        if grip == Grip.ON and holds is None:\n",
    ),
    bug(
        WALK,
        "A robot that was moved meanwhile goes on.",
        "        return Doubt(Reason.INTERRUPTED, MOVED(robot=belief.robot.name), NOBODY_KNOWS())",
        "        return None",
    ),
    bug(
        WALK,
        "What is proven done begins anew.",
        "            if outcome is not Fate.DONE:\n                step.begin_anew()",
        "            if outcome is None or outcome is Fate.DONE:\n                step.begin_anew()",
    ),
    bug(
        "trees/node_state.py",
        "It is not kept that a command is done.",
        '        "done": entry.state is State.DONE,\n',
        '        "done": False,\n',
    ),
    bug(
        TRAIL,
        "A sequence goes on with its first step.",
        "node.current_child = next(going, node.children[0])",
        "node.current_child = node.children[0]",
    ),
    bug(
        TRAIL,
        "One more command than there was is explained.",
        "return 0 <= now.accepted - before.accepted <= most\n",
        "return 0 <= now.accepted - before.accepted <= most + 1\n",
    ),
    bug(
        "resume/keeping.py",
        "Which robots a task has used is not kept.",
        "            used=sorted(context.commands.used),\n",
        "            used=(),\n",
    ),
    bug(
        "resume/keeping.py",
        "A task is kept when it begins, and never again.",
        "        if state == self._last_state:\n            return None\n",
        "        if self._last_state and numbers == self._kept_of[-1]:\n            return None\n",
    ),
    bug(
        "resume/keeping.py",
        "A recipe that was changed goes on where it was.",
        "            return made == self._begun.made\n",
        "            return True\n",
    ),
    bug(
        "trees/tree_run.py",
        "What a dropped tree does not end goes on.",
        "        self._context.commands.cancel_all()  # py_trees does not terminate a leaf that raised\n",
        "",
    ),
)
TREE_BUGS = (*OF_LEAVES, *OF_PLACES, *OF_CELLS, *OF_WALK_BACK)
