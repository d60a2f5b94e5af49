"""Bugs of the engine: the steps around steps, and what a recipe says of devices."""

from __future__ import annotations

from .engine_bug import bug

DECORATORS, HANDLES, HOLDING = "recipes/decorators.py", "recipes/handles.py", "recipes/holding.py"
AUTHORING = "recipes/authoring.py"

RECIPE_BUGS = (
    bug(
        DECORATORS,
        "One try too many.",
        "spent = self.tries >= self.times or",
        "spent = self.tries > self.times or",
    ),
    bug(
        DECORATORS,
        "Any failure is tried again.",
        " or failure is None or failure.reason not in self.causes",
        "",
    ),
    bug(
        DECORATORS,
        "The pause before another try is left out.",
        "self.again_at = self.time.now + max(self.pause_s, LEAST_S)",
        "self.again_at = self.time.now + LEAST_S",
    ),
    bug(
        DECORATORS,
        "The tries of a step are not kept for the next start.",
        'return {"tries": self.tries} if self.status is Status.RUNNING else None',
        'return {"tries": 0} if self.status is Status.RUNNING else None',
    ),
    bug(
        DECORATORS,
        "A second time round a retry has no tries left.",
        "        self.tries, self.again_at = 0, None\n",
        "        self.again_at = None\n",
    ),
    bug(
        DECORATORS,
        "A failure that was tried again stays the cause.",
        "        self.tries += 1\n        self.failures.forgive()\n",
        "        self.tries += 1\n",
    ),
    bug(
        DECORATORS,
        "One turn too few.",
        "if self.done >= self.times:",
        "if self.done >= self.times - 1:",
    ),
    bug(
        DECORATORS,
        "The turns of a repeat are not kept.",
        'return {"done": self.done} if self.status is Status.RUNNING else None',
        "return None",
    ),
    bug(
        DECORATORS,
        "A timeout leaves its step at work.",
        "        self.decorated.stop(Status.INVALID)\n        sentence = TOO_LATE",
        "        sentence = TOO_LATE",
    ),
    bug(
        DECORATORS,
        "A timeout never comes.",
        "if self.decorated.status is not Status.RUNNING or self.time.now < self.until:",
        "if self.decorated.status is not Status.RUNNING or self.time.now <= self.until + self.seconds:",
    ),
    bug(
        DECORATORS,
        "What a fallback has answered stays a failure.",
        "        if self.decorated.status is Status.FAILURE:\n            self.failures.forgive()\n"
        "        return self.decorated.status\n",
        "        return self.decorated.status\n",
    ),
    bug(
        DECORATORS,
        "A rescue that succeeds mends the task.",
        "            self.failures.bring_back(with_second(self.cause, self.failures.first), self.leaf)\n"
        "        return Status.FAILURE",
        "            self.failures.bring_back(with_second(self.cause, self.failures.first), self.leaf)\n"
        "        return self.decorated.status",
    ),
    bug(
        DECORATORS,
        "A rescue forgets the first cause.",
        "self.failures.bring_back(with_second(self.cause, self.failures.first), self.leaf)",
        "self.failures.bring_back(self.failures.first or self.cause, self.leaf)",
    ),
    bug(
        DECORATORS,
        "A rescue runs after a stop.",
        "and first is not None and first.reason in NO_RESCUE:",
        "and first is None:",
    ),
    bug(
        DECORATORS,
        "The cause of a rescue is not kept.",
        '        return {"cause": failure_kept(self.cause)}\n',
        "        return None\n",
    ),
    bug(
        DECORATORS,
        "An inverted step that succeeds, succeeds.",
        "            self.failures.add(Failure(reason=Reason.REJECTED, sentence=sentence), self)\n"
        "            return Status.FAILURE\n        return self.decorated.status",
        "            return Status.SUCCESS\n        return self.decorated.status",
    ),
    bug(
        DECORATORS,
        "An inverted step that fails leaves its cause.",
        "            self.failures.forgive()\n            return Status.SUCCESS",
        "            return Status.SUCCESS",
    ),
    bug(
        HANDLES,
        "A check of several facts is met by the last one.",
        "        for name in self._unsaid(facts):\n            reported, value",
        "        for name in self._unsaid(facts)[1:]:\n            reported, value",
    ),
    bug(
        HANDLES,
        "A wait for several facts ends with the first.",
        "lambda: not self._unsaid(facts_wanted), at_most_s, late)",
        "lambda: len(self._unsaid(facts_wanted)) < max(len(facts_wanted), 1), at_most_s, late)",
    ),
    bug(
        HANDLES,
        "The answer of an earlier turn is kept.",
        "return self._answer if self.entry is None else self.entry.answer",
        "return self._answer or (None if self.entry is None else self.entry.answer)",
    ),
    bug(
        HANDLES,
        "An answer is not kept for the next start.",
        'return super().kept() if self.answer is None else {"answer": self.answer}',
        "return super().kept()",
    ),
    bug(
        HANDLES,
        "The answer of a question is not told to people.",
        "            self.context.note(TaskAnswer(by=self.by, asked=self.asked, answer=self.answer))\n",
        "            pass\n",
    ),
    bug(
        HANDLES,
        "A command that gets in the way of a zone asks for none.",
        "return sequence(act.title, *zones, act) if zones else act",
        "return act",
    ),
    bug(
        HANDLES,
        "A shared device is used without being noted.",
        "if isinstance(node, Leaf) and node.uses is None:",
        "if isinstance(node, Leaf) and node.uses is not None:",
    ),
    bug(
        HANDLES,
        "Where a part is brought back is forgotten.",
        "        self._context.parts.back[self._device.name] = self._pose(target)\n",
        "        self._pose(target)\n",
    ),
    bug(
        HOLDING,
        "Shared devices are not given back.",
        "    return [*late, *leave_devices(context, devices)]",
        "    return late",
    ),
    bug(
        HOLDING,
        "A device is taken in one way of several.",
        "    return all(certain for _, certain in branches)",
        "    return any(certain for _, certain in branches)",
    ),
    bug(
        HOLDING,
        "A device is given back before its last use.",
        "last = {device: index for index, devices in enumerate(needed) for device in devices - people}",
        "last = {d: i for i, devices in reversed(list(enumerate(needed))) for d in devices - people}",
    ),
    bug(
        AUTHORING,
        "A parallel is done with its first branch.",
        "    policy = common.ParallelPolicy.SuccessOnAll(synchronise=True)",
        "    policy = common.ParallelPolicy.SuccessOnOne()",
    ),
    bug(
        AUTHORING,
        "A choice goes the first way, whatever is answered.",
        "            return question.is_answered(value)\n",
        "            return question.answer is not None\n",
    ),
    bug(
        AUTHORING,
        "Retry counts the first try, too.",
        '_times(times, "times of retry", 0), _seconds',
        '_times(times, "times of retry", 0) - 1, _seconds',
    ),
)
