"""Other ways to write the steps of a drawn recipe as XML, with the nodes that only such trees have.

Each does the same as the plainest way, by the rules of BehaviorTree.CPP and Nav2. Where a node may never come
stands a verb that would be seen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from xml.etree.ElementTree import Element, SubElement

from arboleda_proofs.simulator.chance import Dice

from .kinds import PROGRAM
from .steps import (
    Choose,
    Fail,
    Fallback,
    Invert,
    Parallel,
    Param,
    Range,
    Recipe,
    Recover,
    Repeat,
    Retry,
    Step,
    Tell,
    Timeout,
    Wait,
    Work,
    walk,
)
from .xml_text import Writer, fits, literal, msec_of

Way = Callable[[Element], None]
PLAINLY = 0.4  # how often a step that could be written in another way is not
AROUND = 0.3  # how often something stands around a step
DEEPEST = 14  # steps within one another to which that is done
LONGER_S = 36_000.0  # than any task
TRUE = ("1 < 2", "2 > 1", "1 < 2 < 3", "'a' != 'b'", "!false", "true || false", "3 - 1 == 2", "2 >= 2")
FALSE = ("2 < 1", "1 > 2", "1 < 3 < 2", "'a' == 'b'", "!true", "true && false", "5 <= 4", "3 != 3")


class SpellingWriter(Writer):
    """Writer that draws how it writes each step of a recipe and of those that it runs."""

    def __init__(self, dice: Dice, recipe: Recipe) -> None:
        super().__init__()
        self._dice = dice
        self._main = recipe.step
        self._verbs = _seen(recipe.step)
        self._depth = 0
        self._again = 0  # nodes around this one that may begin it anew
        self._names = 0  # of variables and trees that were made up

    def add(self, parent: Element, step: Step) -> None:
        """Write a step below a node."""
        if not self._depth:
            self._again = int(step is not self._main)  # a recipe that another one runs may be run again
        self._depth += 1
        if self._depth < DEEPEST and self._dice.chance(AROUND):
            self._dice.pick(self._around(step))(parent)
        else:
            self._write(parent, step)
        self._depth -= 1

    def _write(self, parent: Element, step: Step) -> None:
        is_plain = self._depth >= DEEPEST or self._dice.chance(PLAINLY)
        ways = () if is_plain and not isinstance(step, Parallel) else self._ways(step)
        if ways:
            self._dice.pick(ways)(parent)
        elif isinstance(step, Retry | Repeat):
            self._again += 1
            super().add(parent, step)
            self._again -= 1
        else:
            super().add(parent, step)

    def _node(self, parent: Element, name: str, *below: Step | Way, **given: str) -> Element:
        """Write a node with these below it."""
        made = SubElement(parent, name, given)
        for each in below:
            if callable(each):
                each(made)
            else:
                self.add(made, each)
        return made

    def _of(self, name: str, *below: Step | Way, **given: str) -> Way:
        """A node with these below it, to be written where it belongs."""

        def write(parent: Element) -> None:
            self._node(parent, name, *below, **given)

        return write

    def _true(self) -> str:
        return self._dice.pick(TRUE)

    def _false(self) -> str:
        return self._dice.pick(FALSE)

    def _holds(self) -> Way:
        return self._of("ScriptCondition", code=self._true())

    def _fails(self) -> Way:
        return self._of("ScriptCondition", code=self._false())

    def _never(self) -> Way | Step:
        """A verb that is told to nobody, as nothing comes here; where the recipe has none, a failure."""
        return self._dice.pick(self._verbs) if self._verbs else self._of("AlwaysFailure")

    def _name(self) -> str:
        self._names += 1
        return f"k{self._names}"

    # -- nodes around any step

    def _around(self, step: Step) -> Sequence[Way]:
        ways = [
            self._of("Sequence", step, _skipIf=self._false()),
            self._of("Sequence", step, _successIf=self._false()),
            self._of("Sequence", step, _failureIf=self._false()),
            self._of("Sequence", step, _while=self._true()),
            self._of("Precondition", step, **{"if": self._true(), "else": "FAILURE"}),
            self._of("IfThenElse", self._holds(), step, self._never()),
            self._of("IfThenElse", self._fails(), self._never(), step),
            self._of("WhileDoElse", self._holds(), step, self._never()),
            self._of("WhileDoElse", self._fails(), self._never(), step),
            self._of("Sequence", self._holds(), step),
            self._of("Sequence", self._left_out(), step),
            self._of("Fallback", self._fails(), step),
            self._of("ReactiveSequence", self._holds(), step),
            self._of("ReactiveFallback", self._fails(), step),
            self._switched(step),
            self._beside_a_long_sleep(step),
            self._with_script(step),
            self._in_a_tree(step),
        ]
        if not self._again:
            ways.append(self._of("RunOnce", step))
        # Between two Inverters what failed has succeeded, and the words of a failure or a rescue are lost.
        if not any(isinstance(each, Fail | Recover) for each in walk(step)):
            ways.append(self._of("Inverter", self._of("Inverter", step)))
        return ways

    def _left_out(self) -> Way:
        """A node that a condition has skipped or ended at once."""
        name, value = self._dice.pick((("_skipIf", True), ("_successIf", True), ("_while", False)))
        return self._of("Sequence", self._never(), **{name: self._true() if value else self._false()})

    def _switched(self, step: Step) -> Way:
        """One case of some, by a number that a script has set."""
        name, many = self._name(), self._dice.pick((2, 3, 4))
        chosen = self._dice.below(many)
        below = [step if number == chosen else self._never() for number in range(many)]
        cases = {f"case_{number + 1}": str(number * 5) for number in range(many)}
        switch = self._of(f"Switch{many}", *below, self._never(), variable=f"{{{name}}}", **cases)
        return self._of("Sequence", self._of("Script", code=f"{name} := {chosen * 5}"), switch)

    def _beside_a_long_sleep(self, step: Step) -> Way:
        sleep = self._of("Sequence", self._of("Sleep", msec=msec_of(LONGER_S)), self._of("AlwaysFailure"))
        return self._of("Parallel", step, sleep, success_count="1")

    def _with_script(self, step: Step) -> Way:
        """The scripts of a node's end count what comes of it, and a condition reads that."""

        def write(parent: Element) -> None:
            name = self._name()
            made = self._node(parent, "Sequence", self._of("Script", code=f"{name} := 1"))
            ended = self._node(made, "Sequence", step)
            ended.set("_onSuccess", f"{name} := {name} + 1")
            ended.set("_onFailure", f"{name} := {name} - 1")
            ended.set("_post", f"{name} := {name} * 3")
            self._node(made, "ScriptCondition", code=f"{name} == 6")

        return write

    def _in_a_tree(self, step: Step) -> Way:
        """The step as a tree of its own, with the variables of this one."""

        def write(parent: Element) -> None:
            name = self._name().upper()
            tree = Element("BehaviorTree", {"ID": name})
            self.trees.append(tree)
            self.add(tree, step)
            SubElement(parent, "SubTree", {"ID": name, **{each: f"{{{each}}}" for each in _variables(step)}})

        return write

    # -- other nodes for a step

    def _ways(self, step: Step) -> Sequence[Way]:
        found = getattr(self, f"_{type(step).__name__.lower()}", None)
        return () if found is None else found(step)

    def _tell(self, step: Tell) -> Sequence[Way]:
        """The verb with a variable for what it works by, to which a script has given that value."""
        value = dict(step.values).get(PROGRAM)
        if isinstance(value, Param | Range | float | None) or step.refused or step.answer:
            return ()
        name = self._name()
        rest = tuple(each for each in step.values if each[0] != PROGRAM)
        tell = replace(step, values=(*rest, (PROGRAM, Param(name=name))))

        def write(parent: Element) -> None:
            made = self._node(parent, "Sequence", self._of("Script", code=f"{name} := {literal(value)}"))
            Writer.add(self, made, tell)

        return (write,)

    def _work(self, step: Work) -> Sequence[Way]:
        if not step.steps:
            return (
                self._of("ForceSuccess", self._of("AlwaysFailure")),
                self._of("Inverter", self._of("AlwaysFailure")),
                self._of("Sequence", self._left_out(), self._of("AlwaysSuccess")),
            )
        ways = [self._of("AsyncSequence", *step.steps), self._in_two(step)]
        return ways if self._again else [*ways, self._of("SequenceWithMemory", *step.steps)]

    def _in_two(self, step: Work) -> Way:
        cut = self._dice.below(len(step.steps))
        first, rest = Work(steps=step.steps[:cut]), Work(steps=step.steps[cut:])
        return self._of("Sequence", first, rest)

    def _wait(self, step: Wait) -> Sequence[Way]:
        sleep = self._of("Sleep", msec=msec_of(step.seconds + LONGER_S))
        return (
            self._of("Delay", self._of("AlwaysSuccess"), delay_msec=msec_of(step.seconds)),
            self._of("ForceSuccess", self._of("Timeout", sleep, msec=msec_of(step.seconds))),
        )

    def _parallel(self, step: Parallel) -> Sequence[Way]:
        many, branches = len(step.branches), [self._branch(each) for each in step.branches]
        ways = [
            self._of("Parallel", *branches, success_count="-1", failure_count="1"),
            self._of("Parallel", *branches, success_count=str(many), failure_count="1"),
            self._of("Parallel", *branches, success_count="-1", failure_count=str(-many)),
            self._of("Parallel", *branches, self._holds(), success_count=str(many + 1)),
            self._of("Parallel", self._fails(), *branches, success_count=str(many), failure_count="2"),
        ]
        if not any(_may_fail(each) for each in step.branches):
            ways.append(self._of("ParallelAll", *branches, max_failures="1"))
        return ways

    def _branch(self, step: Step) -> Way:
        """A branch of a parallel, in which no verb of the others stands."""

        def write(parent: Element) -> None:
            before, self._verbs = self._verbs, [each for each in _seen(step) if each in self._verbs]
            self.add(parent, step)
            self._verbs = before

        return write

    def _choose(self, step: Choose) -> Sequence[Way]:
        ways = [self._one_by_one("IfThenElse", step)]
        if step.answer not in {name for _, way in step.ways for name in _variables(way)}:
            ways += [self._one_by_one("WhileDoElse", step), self._of("Sequence", *self._those_that_fit(step))]
        return ways

    def _one_by_one(self, name: str, step: Choose) -> Way:
        """A node for each answer, each within the other."""
        rest: Way = self._of("AlwaysFailure")
        for value, way in reversed(step.ways):
            condition = self._of("ScriptCondition", code=fits(step, value))
            rest = self._of(name, condition, way, rest)
        return rest

    def _those_that_fit(self, step: Choose) -> list[Way]:
        """Each way with a condition: those of other answers are skipped."""
        found = []
        for value, way in step.ways:
            code = fits(step, value)
            if self._dice.chance(0.5):
                found.append(self._of("Precondition", way, **{"if": code, "else": "SKIPPED"}))
            else:
                found.append(self._of("Sequence", way, _skipIf=f"!({code})"))
        return found

    def _retry(self, step: Retry) -> Sequence[Way]:
        success, times = self._of("AlwaysSuccess"), str(step.times)
        return (
            self._begun_again(self._of("RecoveryNode", step.step, success, number_of_retries=times)),
            self._begun_again(self._of("Fallback", *[step.step] * (step.times + 1))),
        )

    def _repeat(self, step: Repeat) -> Sequence[Way]:
        queue = ";".join(str(number) for number in range(step.times))
        variable = f"{{{self._name()}}}"
        return (
            self._begun_again(self._of("LoopInt", step.step, queue=queue, value=variable)),
            self._begun_again(self._of("ForEach", step.step, vector_in=queue, out=variable)),
            self._begun_again(self._of("Sequence", *[step.step] * step.times)),
        )

    def _begun_again(self, way: Way) -> Way:
        def write(parent: Element) -> None:
            self._again += 1
            way(parent)
            self._again -= 1

        return write

    def _timeout(self, step: Timeout) -> Sequence[Way]:
        sleep, failure = self._of("Sleep", msec=msec_of(step.seconds)), self._of("AlwaysFailure")
        name = self._name()
        turn = self._of("Script", code=f"{name} := 2")
        clock = self._of("Sequence", sleep, turn, self._of("Sleep", msec=msec_of(LONGER_S)))
        is_first = self._of("ScriptCondition", code=f"{name} == 1")
        in_time = (
            self._of("WhileDoElse", is_first, step.step, failure),
            self._of("ReactiveSequence", is_first, step.step),
            self._of("Sequence", self._of("Sequence", step.step, _while=f"{name} == 1"), is_first),
            self._of("Switch2", step.step, failure, failure, variable=f"{{{name}}}", case_1="1", case_2="2"),
        )
        return (
            self._of("Parallel", step.step, self._of("Sequence", sleep, failure), success_count="1"),
            *(
                self._of(
                    "Sequence",
                    self._of("Script", code=f"{name} := 1"),
                    self._of("Parallel", clock, each, success_count="1"),
                )
                for each in in_time
            ),
        )

    def _fallback(self, step: Fallback) -> Sequence[Way]:
        *before, last = step.steps
        rest: Step | Way = last
        for each in reversed(before):
            rest = self._of("IfThenElse", each, self._of("AlwaysSuccess"), rest)
        return (rest, self._of("AsyncFallback", *step.steps)) if callable(rest) else ()

    def _recover(self, step: Recover) -> Sequence[Way]:
        steps = step.work.steps if isinstance(step.work, Work) and step.work.steps else (step.work,)
        return (self._of("TryCatch", *steps, step.rescue),)

    def _invert(self, step: Invert) -> Sequence[Way]:
        return (
            self._of("IfThenElse", step.step, self._of("AlwaysFailure"), self._of("AlwaysSuccess")),
            self._of("ForceSuccess", step.step),
        )


def _seen(step: Step) -> list[Step]:
    return [each for each in walk(step) if _is_seen(each)]


def _is_seen(step: Step) -> bool:
    """True for a verb that is seen where it is told: it takes no variable, and is not to be refused."""
    if not isinstance(step, Tell) or step.refused or step.answer:
        return False
    return not any(isinstance(value, Param) for _, value in step.values)


def _may_fail(step: Step) -> bool:
    return any(isinstance(each, Fail | Timeout | Invert | Fallback | Choose) for each in walk(step))


def _variables(step: Step) -> list[str]:
    """The variables that a step reads or writes."""
    found: dict[str, None] = {}
    for each in walk(step):
        answer = getattr(each, "answer", "")
        given = [value for _, value in getattr(each, "values", ())]
        given += [getattr(each, name, None) for name in ("target", "place")]
        found |= {answer: None} if answer else {}
        found |= {value.name: None for value in given if isinstance(value, Param)}
    return list(found)
