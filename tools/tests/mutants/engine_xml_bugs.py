"""Bugs of the engine: trees of files, by the rules of BehaviorTree.CPP."""

from __future__ import annotations

from .engine_bug import bug

CONTROLS, DECORATORS, NODE = (f"bt_xml/running/{name}.py" for name in ("controls", "decorators", "node"))
ROOT, STEPS, LEAVES = (f"bt_xml/running/{name}.py" for name in ("root", "device_steps", "leaves"))
SCRIPTS, MEMORY = "bt_xml/running/scripts.py", "bt_xml/running/memory.py"

XML_BUGS = (
    bug(
        CONTROLS,
        "A sequence that failed goes on where it was.",
        '        """The result once a child has ended as `stops` says; the children begin anew."""\n'
        "        self.reset_children()\n        self.at = 0\n",
        '        """The result once a child has ended as `stops` says; the children begin anew."""\n'
        "        self.reset_children()\n",
    ),
    bug(
        CONTROLS,
        "A sequence begins anew at every tick.",
        "        if self.begin():\n            self.skipped = 0\n        while self.at < len(self.below):",
        "        self.begin()\n        self.at = 0\n        while self.at < len(self.below):",
    ),
    bug(
        CONTROLS,
        "A sequence leaves its last child out.",
        "        while self.at < len(self.below):\n            child = self.below[self.at]\n"
        "            was_idle",
        "        while self.at < max(len(self.below) - 1, 1):\n            child = self.below[self.at]\n"
        "            was_idle",
    ),
    bug(
        CONTROLS,
        "TryCatch succeeds where its last child does.",
        "        return FAILURE if failed else SKIPPED if all_skipped else SUCCESS",
        "        return SKIPPED if all_skipped else SUCCESS",
    ),
    bug(
        CONTROLS,
        "A reactive node does not halt what ran before.",
        "                    if other is not child:\n                        other.reset()\n",
        "                    if other is child:\n                        break\n",
    ),
    bug(
        CONTROLS,
        "A parallel counts a child twice.",
        "                    self.ended = [*self.ended, number]\n"
        "                    self.done += result is SUCCESS",
        "                    self.done += result is SUCCESS",
    ),
    bug(
        CONTROLS,
        "A parallel that is over leaves its children at work.",
        "    def _over(self, result: Result) -> Result:\n        self.reset_counts()\n"
        "        self.reset_children()\n",
        "    def _over(self, result: Result) -> Result:\n        self.reset_counts()\n",
    ),
    bug(
        CONTROLS,
        "A parallel fails one failure too late.",
        "self.failed == too_many:",
        "self.failed > too_many:",
    ),
    bug(
        CONTROLS,
        "A negative threshold is one too low.",
        "return max(many + int(number) + 1, 0) if number < 0",
        "return max(many + int(number), 0) if number < 0",
    ),
    bug(
        CONTROLS,
        "ParallelAll fails one failure too late.",
        "        result = FAILURE if self.failed >= too_many else SUCCESS",
        "        result = FAILURE if self.failed > too_many else SUCCESS",
    ),
    bug(
        CONTROLS,
        "If and else are taken for each other.",
        "self.at = 1 if result is SUCCESS else 2",
        "self.at = 2 if result is SUCCESS and len(self.below) > 2 else 1",
    ),
    bug(
        CONTROLS,
        "A while that turns does not halt the other way.",
        "            self.below[1].reset()\n            result = self.below[2].execute()",
        "            result = self.below[2].execute()",
    ),
    bug(
        CONTROLS,
        "A switch takes the case after the one that it has.",
        '            case = self.ports.text(f"case_{number + 1}", scope)',
        '            case = self.ports.text(f"case_{max(number, 1)}", scope)',
    ),
    bug(
        CONTROLS,
        "A switch that turns does not halt the case before.",
        "            self.below[self.ran].reset()\n",
        "            self.ran = chosen\n",
    ),
    bug(
        DECORATORS,
        "One round too many.",
        "        while self.rounds < most or most == -1:\n            if self.child",
        "        while self.rounds <= most or most == -1:\n            if self.child",
    ),
    bug(
        DECORATORS,
        "The rounds of a loop are not forgotten at its end.",
        "        self.rounds = 0\n        return self.goes_on",
        "        return self.goes_on",
    ),
    bug(
        DECORATORS,
        "A loop without an end ends at once.",
        "        while self.rounds < most or most == -1:\n            if self.child",
        "        while self.rounds < most:\n            if self.child",
    ),
    bug(
        DECORATORS,
        "An inverter inverts only failures.",
        "INVERTED = {SUCCESS: FAILURE, FAILURE: SUCCESS}",
        "INVERTED = {SUCCESS: SUCCESS, FAILURE: SUCCESS}",
    ),
    bug(
        DECORATORS,
        "ForceSuccess fails.",
        "ALL_DONE = {SUCCESS: SUCCESS, FAILURE: SUCCESS}",
        "ALL_DONE = {SUCCESS: SUCCESS, FAILURE: FAILURE}",
    ),
    bug(
        DECORATORS,
        "Milliseconds are taken for seconds.",
        "self.until = self.time.now + self.ports.number(self.port, self.scope) / 1000",
        "self.until = self.time.now + self.ports.number(self.port, self.scope)",
    ),
    bug(
        DECORATORS,
        "A timeout leaves its child at work.",
        "            self.child.reset()\n            self.started = False\n            return FAILURE",
        "            self.started = False\n            return FAILURE",
    ),
    bug(
        DECORATORS,
        "A delay delays nothing the second time.",
        "        if self.time.now < self.until:\n            return RUNNING\n"
        "        result = self.child.execute()\n"
        "        if result in ENDED:\n            self.started = False\n",
        "        if self.time.now < self.until:\n            return RUNNING\n"
        "        result = self.child.execute()\n"
        "        if result in ENDED:\n            self.started = True\n",
    ),
    bug(
        DECORATORS,
        "A precondition is asked at every tick.",
        "        if not self.is_under_way:\n            self.is_under_way = self.script.holds(self.scope)\n",
        "        self.is_under_way = self.script.holds(self.scope)\n",
    ),
    bug(
        DECORATORS,
        "ForEach leaves out the last value.",
        'return [each.strip() for each in str(value).split(";") if each.strip()]',
        'return [each.strip() for each in str(value).split(";")[:-1] if each.strip()]',
    ),
    bug(
        DECORATORS,
        "Variables of a subtree are not kept.",
        "    def kept(self) -> Mapping[str, Any] | None:\n        return self.child.scope.kept()",
        "    def kept(self) -> Mapping[str, Any] | None:\n        return None",
    ),
    bug(
        NODE,
        "A node that is halted does not halt those below.",
        "        self.reset_counts()\n        self.reset_children()\n        self.rests_until = None\n",
        "        self.reset_counts()\n        self.rests_until = None\n",
    ),
    bug(
        NODE,
        "A skip that a condition decides is a failure.",
        '("_successIf", SUCCESS), ("_skipIf", SKIPPED)',
        '("_successIf", SUCCESS), ("_skipIf", FAILURE)',
    ),
    bug(
        NODE,
        "The scripts of success run at a failure.",
        '{SUCCESS: "_onSuccess", FAILURE: "_onFailure"}',
        '{SUCCESS: "_onFailure", FAILURE: "_onSuccess"}',
    ),
    bug(
        NODE,
        "The progress of nodes is not kept.",
        "return {name: value for name in self.counts if (value := getattr(self, name))}",
        "return {}",
    ),
    bug(
        NODE,
        "While a node runs its condition is not asked.",
        "            if script is None or script.holds(self.scope):\n                return None\n"
        "            self.halt()\n            return SKIPPED\n",
        "            return None\n",
    ),
    bug(
        ROOT,
        "A failure from which a tree has recovered stays the task's.",
        "            self._note(cause)\n            self.failures.forgive()\n",
        "            self._note(cause)\n",
    ),
    bug(
        ROOT,
        "A tree recovers from a stop.",
        "        if result is FAILURE and cause is not None and cause.reason not in FINAL:\n",
        "        if result is FAILURE and cause is not None:\n",
    ),
    bug(
        ROOT,
        "A tree that fails names no cause.",
        "cause = self.causes[0] if self.causes else generic(self.name, self.blamed)",
        "cause = generic(self.name, self.blamed)",
    ),
    bug(
        ROOT,
        "A script that breaks halts nothing.",
        "            first = put_aside(self.below[0])\n            self._halt_all()\n",
        "            first = put_aside(self.below[0])\n",
    ),
    bug(
        ROOT,
        "A tree that is halted leaves its steps at work.",
        "        self._halt_all()\n        self.below[0].reset()\n        self.status = Status.INVALID\n",
        "        self.status = Status.INVALID\n",
    ),
    bug(
        ROOT,
        "A rescue forgets the cause.",
        "        self._bring_back(with_second(self.cause, second))",
        "        self._bring_back(second or self.cause)",
    ),
    bug(
        STEPS,
        "A step keeps the values of its first turn.",
        "(values := self.order.values(self.scope)) != (self.anew or self.built):",
        "not self.anew and (values := self.order.values(self.scope)) != self.built:",
    ),
    bug(
        STEPS,
        "The values of a step are not kept.",
        '        if "anew" in state:\n            self._take(state["anew"])\n',
        "",
    ),
    bug(
        STEPS,
        "A variable gets an answer that was not given.",
        "            self.scope.set(self.out, as_variable(self.ask.answer))\n",
        "            self.scope.set(self.out, as_variable(self.ask.answers[0]))\n",
    ),
    bug(
        STEPS,
        "A number beyond its limits is told.",
        "    if port.limits and not port.limits[0] <= values.number(text) <= port.limits[1]:\n",
        "    if port.limits and not port.limits[0] <= values.number(text):\n",
    ),
    bug(
        LEAVES,
        "A sleep counts seconds.",
        'self.until = self.time.now + self.ports.number("msec", self.scope) / 1000',
        'self.until = self.time.now + self.ports.number("msec", self.scope)',
    ),
    bug(
        LEAVES,
        "A step that is halted goes on.",
        "        if self.step.status is Status.RUNNING:\n            self.step.stop(Status.INVALID)",
        "        if self.step.status is Status.FAILURE:\n            self.step.stop(Status.INVALID)",
    ),
    bug(
        LEAVES,
        "A condition that does not hold succeeds.",
        "return SUCCESS if self.script.holds(self.scope) else FAILURE",
        "return SUCCESS",
    ),
    bug(
        SCRIPTS,
        "Of a chain of comparisons only the last counts.",
        "return float(all(_compare(left, sign, right) for (left, right), sign in rows))",
        "return float(any(_compare(left, sign, right) for (left, right), sign in rows))",
    ),
    bug(
        SCRIPTS,
        "Less and greater are taken for each other.",
        '    "<": operator.lt,\n    ">": operator.gt,\n',
        '    "<": operator.gt,\n    ">": operator.lt,\n',
    ),
    bug(
        MEMORY,
        "A variable of a subtree that stands for another one is its own.",
        "                scope, name = around, scope.names[name]\n",
        "                return scope, name\n",
    ),
)
