"""Kit that draws: what a recipe in Python calls makes nodes of a tree, as they are written in XML."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from py_trees import composites

from arboleda.drivers import Value, quoted, shown
from arboleda.engine import Context
from arboleda.model.messages import Reason
from arboleda.recipes import Kit, Step, work
from arboleda.recipes.authoring import Making
from arboleda.recipes.handles import flat, question_of
from arboleda_trees.bt_xml import leaves, values
from arboleda_trees.bt_xml.nodes import Kind, PortDirection
from arboleda_trees.bt_xml.values import Variable

from .errors import EditError

MOST_WAYS = 6  # of a Switch
NO_NODE = "no node in XML does this; a node in Python can (@node)"


class DrawnStep(composites.Sequence):
    """Step of a recipe as a node: its kind, what its attributes say, and the steps in it.

    `real`: what the recipe would do; `chosen_by`: the step by whose answer one of those in it is taken.
    """

    def __init__(
        self,
        kind: str,
        attributes: Mapping[str, str] | None = None,
        below: Sequence[Step] = (),
        *,
        name: str = "",
        real: Step | None = None,
        chosen_by: DrawnStep | None = None,
    ) -> None:
        super().__init__(name or kind, memory=True, children=list(below))
        self.kind = kind
        self.attributes = dict(attributes or {})
        self.real = real
        self.chosen_by = chosen_by


def refusal(step: str, why: str) -> EditError:
    """The error for a step that no tree in XML can say."""
    return EditError(f"{step} cannot be drawn: {why}")


def text_of(step: str, name: str, value: Value) -> str:
    """A value as an attribute has it; EditError where it would be read as a variable."""
    text = shown(value)
    if isinstance(values.read(name, text), Variable):
        raise refusal(step, f"{name} {quoted(text)} would be read as a variable")
    return text


class DrawingKit(Kit):
    """Kit whose devices and steps are drawn; it raises the same errors for wrong arguments as a Kit."""

    def __init__(self, context: Context, making: Making | None = None) -> None:
        super().__init__(context, making)
        self.kinds = leaves.of_cell(context.cell)

    def device(self, role: str) -> Any:
        return _DrawingHandle(role, super().device(role), self.kinds)

    def place(self, target: str) -> Any:
        return _DrawingHandle("place", super().place(target), self.kinds, {"place": target})

    def using(self, roles: str | Sequence[str], *parts: Step | Sequence[Step]) -> Step:
        names = [roles] if isinstance(roles, str) else roles
        cell = self._context.cell
        if shared := [role for role in names if self._named(role).name in cell.shared]:
            why = f"{shared[0]} is shared with other cells; a tree holds it from its first use to its last"
            raise refusal(f"using({', '.join(names)})", why)
        return work(*parts)

    def choose(self, question_step: Step, ways: Mapping[Value, Step | Sequence[Step]]) -> Step:
        real = question_step.real if isinstance(question_step, DrawnStep) else None
        super().choose(real or question_step, dict.fromkeys(ways, ()))  # which refuses wrong choices
        name = f"choose of {question_step.name}"
        question = question_of(real or question_step)
        has_ranges = question is not None and question.number is not None
        if has_ranges and any(isinstance(value, str) for value in ways):
            raise refusal(name, "its ways are ranges of a number, and a Switch has single values")
        if len(ways) > MOST_WAYS:
            raise refusal(name, f"it has {len(ways)} ways, and a Switch at most {MOST_WAYS}")
        branches = [_one(way) for way in ways.values()]
        if len(branches) == 1:
            return branches[0]
        cases = {f"case_{n}": text_of(name, "a case", value) for n, value in enumerate(ways, 1)}
        others = DrawnStep("AlwaysFailure")
        assert isinstance(question_step, DrawnStep)
        return DrawnStep(f"Switch{len(ways)}", cases, [*branches, others], name=name, chosen_by=question_step)

    def fail(self, sentence: str) -> Step:
        return DrawnStep("AlwaysFailure", {"_description": text_of("fail", "_description", str(sentence))})

    def wait(self, seconds: float) -> Step:
        return DrawnStep("Sleep", {"msec": _msec("wait", seconds)})

    def retry(
        self,
        step: Step,
        *,
        times: int = 2,
        pause_s: float = 1.0,
        causes: Collection[Reason | str] | None = None,
    ) -> Step:
        if causes is not None:
            raise refusal("retry", "a node that tries again does so whatever the cause; leave out causes")
        tried = _one(step)
        if pause_s:
            pause = DrawnStep("Sleep", {"msec": _msec("retry", pause_s)})
            tried = DrawnStep("Fallback", {}, [tried, DrawnStep("Inverter", {}, [pause])])
        return DrawnStep("RetryUntilSuccessful", {"num_attempts": str(times + 1)}, [tried])

    def repeat(self, step: Step, times: int) -> Step:
        return DrawnStep("Repeat", {"num_cycles": str(times)}, [_one(step)])

    def timeout(self, step: Step, seconds: float) -> Step:
        if not round(seconds * 1000):
            raise refusal("timeout", "0 ms are no limit in XML")
        return DrawnStep("Timeout", {"msec": _msec("timeout", seconds)}, [_one(step)])

    def fallback(self, *parts: Step) -> Step:
        return DrawnStep("Fallback", {}, parts)

    def recover(self, work: Step | Sequence[Step], rescue: Step | Sequence[Step]) -> Step:
        return DrawnStep("TryCatch", {}, [_one(work), _one(rescue)])

    def invert(self, step: Step) -> Step:
        return DrawnStep("Inverter", {}, [_one(step)])


class _DrawingHandle:
    """A device or a place of the cell whose steps are drawn; `real` is asked whether it has them.

    `given`: the values that each of its nodes has.
    """

    def __init__(
        self, role: str, real: Any, kinds: Mapping[str, Kind], given: Mapping[str, Value] | None = None
    ) -> None:
        self._role = role
        self._real = real
        self._kinds = kinds
        self._given = dict(given or {})

    def __getattr__(self, verb: str) -> Callable[..., Step]:
        method = getattr(self._real, verb)
        name = f"{self._role}.{verb}"
        kind = self._kinds.get(f"{self._role}_{verb}")
        if kind is None:
            raise refusal(name, NO_NODE)
        ports = [port.name for port in (kind.ports or {}).values() if port.direction is not PortDirection.OUT]

        def step(*in_order: Any, **by_name: Any) -> Step:
            around = verb == "visit"  # the first value is the target, all others are steps there
            outer, inner = (in_order[:1], in_order[1:]) if around else (in_order, ())
            real = method(*outer, **by_name)
            found = self._given | dict(zip(ports, outer, strict=False)) | by_name
            attributes = {key: self._text(name, key, value) for key, value in found.items()}
            below = flat(inner, "visit")
            if around and not below:
                return DrawnStep(f"{self._role}_go", attributes, name=name)
            body = [_one(below)] if below else []
            return DrawnStep(kind.name, attributes, body, name=name, real=real if question_of(real) else None)

        return step

    def _text(self, name: str, port: str, value: Any) -> str:
        if isinstance(value, str | int | float):
            return text_of(name, port, value)
        if wrong := [each for each in value if ";" in each or "{" in each]:
            raise refusal(
                name, f"the answer {quoted(wrong[0])} has a sign that separates answers, or a brace"
            )
        return ";".join(value)


def _one(step: Step | Sequence[Step]) -> Step:
    """The step, or several of them as one."""
    parts = flat([step])
    return parts[0] if len(parts) == 1 else DrawnStep("Sequence" if parts else "AlwaysSuccess", {}, parts)


def _msec(step: str, seconds: float) -> str:
    msec = round(seconds * 1000)
    if abs(msec - seconds * 1000) > 1e-6:
        raise refusal(step, f"{seconds:g} s are no whole number of milliseconds")
    return str(msec)
