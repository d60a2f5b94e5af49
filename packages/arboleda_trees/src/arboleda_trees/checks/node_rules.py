"""Rules of a walkthrough for the nodes of trees as XML: the outcome of each class of nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

from py_trees.behaviour import Behaviour

from arboleda.drivers import ArboledaError
from arboleda.kinds.ranges import apart
from arboleda.model.by_class import nearest
from arboleda.plant_check.foresight import Scene
from arboleda.plant_check.step_rules import at_once, repeated, tried
from arboleda.plant_check.walkthrough import Outcome, Rule, Walkthrough, asked_by, few, key_of, last_answer
from arboleda.recipes.handles import Ask, question_of
from arboleda_trees.bt_xml.comparing import compared
from arboleda_trees.bt_xml.running import controls, decorators, leaves, watching
from arboleda_trees.bt_xml.running.device_steps import DeviceStep, FactStep, QuestionStep, as_variable
from arboleda_trees.bt_xml.running.memory import Scope
from arboleda_trees.bt_xml.running.node import FAILURE, SKIPPED, SUCCESS, Node, Result
from arboleda_trees.bt_xml.running.ports import NodePorts
from arboleda_trees.bt_xml.running.python_nodes import FunctionNode, WrapperNode
from arboleda_trees.bt_xml.running.root import Main
from arboleda_trees.bt_xml.running.scripts import Script, ScriptError, is_true

from .scene_variables import after_script, ports_in, run, scope_in

MANY = 1_000_000  # rounds of a loop without an end


def _node(walk: Walkthrough, node: Node, scenes: Sequence[Scene]) -> Outcome:
    """The outcome of any node: its conditions, what it does, and its scripts."""
    with walk.at(None if node.place is None else str(node.place)):
        begin, decided = _by_condition(walk, node, scenes)
        ticked = _ticked(walk, node, begin) if begin else Outcome()
        if "_while" in node.before and begin:
            ticked = ticked.plus(skipped=walk.blurred(node, begin))
    both = decided.plus_all(ticked)
    return Outcome(
        done=_after(node, "_onSuccess", both.done),
        failed=_after(node, "_onFailure", both.failed),
        skipped=both.skipped,
    )


def _ticked(walk: Walkthrough, node: Node, scenes: Sequence[Scene]) -> Outcome:
    try:
        return (nearest(NODES, type(node)) or Walkthrough.unsure)(walk, node, scenes)
    except ScriptError:  # a value of a port that it cannot have: the task fails
        return Outcome()


def _after(node: Node, name: str, scenes: Sequence[Scene]) -> tuple[Scene, ...]:
    first = after_script(node.after.get(name), node.scope, scenes)
    return tuple(after_script(node.after.get("_post"), node.scope, list(first)))


CONDITIONS = (("_failureIf", FAILURE), ("_successIf", SUCCESS), ("_skipIf", SKIPPED), ("_while", None))


def _by_condition(
    walk: Walkthrough, node: Node, scenes: Sequence[Scene]
) -> tuple[tuple[Scene, ...], Outcome]:
    """The scenes in which a node is ticked, and the outcome of those in which its conditions decide."""
    decided = Outcome()
    for name, result in CONDITIONS:
        written = node.before.get(name)
        if written is not None:
            true, false = _split(walk, written, node, scenes)
            scenes, ends = (true, false) if result is None else (false, true)
            decided = _with(decided, result or SKIPPED, ends)
    return tuple(scenes), decided


def _with(outcome: Outcome, result: Result, scenes: Sequence[Scene]) -> Outcome:
    if result is SUCCESS:
        return outcome.plus(done=scenes)
    return outcome.plus(failed=scenes) if result is FAILURE else outcome.plus(skipped=scenes)


def _split(
    walk: Walkthrough, written: Script, node: Node, scenes: Sequence[Scene]
) -> tuple[tuple[Scene, ...], tuple[Scene, ...]]:
    """The scenes after a script that is true, and after one that is false."""
    true: list[Scene] = []
    false: list[Scene] = []
    for scene in scenes:
        try:
            value, after = run(written, node.scope, scene)
            sure = None if value is None else is_true(value)
        except ScriptError:
            continue
        walk.doubts += sure is None
        true += [after] if sure in (True, None) else []
        false += [after] if sure in (False, None) else []
    return tuple(true), tuple(false)


def _constant(walk: Walkthrough, node: leaves.ConstantLeaf, scenes: Sequence[Scene]) -> Outcome:
    return _with(Outcome(), node.result, scenes)


def _script(walk: Walkthrough, node: leaves.RunScript, scenes: Sequence[Scene]) -> Outcome:
    return Outcome(done=tuple(after_script(node.script, node.scope, scenes)))


def _script_condition(walk: Walkthrough, node: leaves.ScriptCondition, scenes: Sequence[Scene]) -> Outcome:
    true, false = _split(walk, node.script, node, scenes)
    return Outcome(done=true, failed=false)


def _set(walk: Walkthrough, node: leaves.SetBlackboard, scenes: Sequence[Scene]) -> Outcome:
    key = key_of(node.scope.place(node.ports.variable("output_key")))
    done = []
    for scene in scenes:
        ports = replace(node.ports, texts={"value": node.ports.texts.get("value", "")})
        variables = ports_in(node.scope, ports, scene)
        done.append(
            scene.without({key}) if variables is None else scene.put({key: ports.text("value", variables)})
        )
    return Outcome(done=tuple(done))


def _writing(walk: Walkthrough, node: Node, scenes: Sequence[Scene]) -> Outcome:
    """The outcome of a leaf that only gives variables values, which are not certain in advance."""
    return Outcome(done=walk.blurred(node, scenes))


def _function(walk: Walkthrough, node: FunctionNode, scenes: Sequence[Scene]) -> Outcome:
    walk.doubts += 1
    return Outcome(done=walk.blurred(node, scenes), failed=tuple(scenes))


def _step(walk: Walkthrough, node: leaves.Step, scenes: Sequence[Scene]) -> Outcome:
    after = walk.follow(node.step, scenes)
    return Outcome(done=after.passed, failed=after.failed)


def _device(walk: Walkthrough, node: DeviceStep, scenes: Sequence[Scene]) -> Outcome:
    if not node.order.variables:
        after = walk.follow(node.step, scenes)
        return Outcome(done=tuple(_answered(node, node.step, after.passed)), failed=after.failed)
    outcome = Outcome()
    for scene in scenes:
        after, step = _with_values(walk, node, scene)
        outcome = outcome.plus(done=_answered(node, step, after.passed), failed=after.failed)
    return outcome


def _with_values(walk: Walkthrough, node: DeviceStep, scene: Scene) -> tuple[Outcome, Behaviour]:
    """The outcome of a step with the values that its variables have in a scene, and that step.

    Where a variable has no certain value, nothing that the step may change is certain after it.
    """
    variables = scope_in(node.scope, node.order.variables.values(), scene)
    if variables is None:
        blurred = walk.blurred(node, [scene])
        return Outcome(done=blurred, failed=blurred), node.step
    try:
        arguments = node.order.values(variables)
        step = node.step if arguments == node.built else node.order.make(dict(arguments))
    except ArboledaError:  # a value that the device does not take: the task fails
        return Outcome(), node.step
    return walk.follow(step, [scene]), step


def _answered(node: DeviceStep, step: Behaviour, scenes: Sequence[Scene]) -> list[Scene]:
    """The scenes after a step; after a question one for each answer."""
    question = question_of(step) if isinstance(node, QuestionStep) else None
    if not isinstance(node, QuestionStep) or question is None:
        return list(scenes)
    key = key_of(node.scope.place(node.out))
    answers = question.answers
    if isinstance(question, Ask) and question.number is not None:
        answers = apart(question.number, compared(_root(node)))
    if not answers:
        return [scene.without({key}) for scene in scenes]
    given = [{key: as_variable(each), **last_answer(question, each)} for each in answers]
    asked = set(asked_by(question))  # no later step has to know that: the answer is known here
    return [scene.without(asked).put(each) for scene in scenes for each in given]


def _root(node: Behaviour) -> Behaviour:
    while node.parent is not None:
        node = node.parent
    return node


def _facts(walk: Walkthrough, node: FactStep, scenes: Sequence[Scene]) -> Outcome:
    done = []
    for scene in scenes:
        facts = {
            key_of(node.scope.place(variable)): scene.get(*fact) for variable, fact in node.facts.items()
        }
        values = {key: as_variable(value) for key, value in facts.items() if value is not None}
        done.append(scene.without(set(facts)).put(values))
    return Outcome(done=tuple(done), failed=tuple(scenes))


def _sequence(walk: Walkthrough, node: controls.OrderedControl, scenes: Sequence[Scene]) -> Outcome:
    return _in_order(walk, node.below, scenes, node.stops)


def _in_order(walk: Walkthrough, below: Sequence[Node], scenes: Sequence[Scene], stops: Result) -> Outcome:
    """The outcome of children one after the other, until one ends as `stops` says."""
    begun: tuple[Scene, ...] = ()
    untouched, ended = tuple(scenes), Outcome()  # untouched: all children before were skipped
    for child in below:
        first = walk.follow(child, untouched)
        after = first if few(begun) == few(untouched) else walk.follow(child, begun)
        both = first.plus(done=after.done, failed=after.failed)
        ended = _with(ended, stops, both.done if stops is SUCCESS else both.failed)
        begun = (*(both.failed if stops is SUCCESS else both.done), *after.skipped)
        untouched = first.skipped
    return _with(ended, FAILURE if stops is SUCCESS else SUCCESS, begun).plus(skipped=untouched)


def _try_catch(walk: Walkthrough, node: controls.TryCatch, scenes: Sequence[Scene]) -> Outcome:
    *below, caught = node.below
    ended = _in_order(walk, below, scenes, FAILURE)
    rescue = walk.follow(caught, ended.failed)
    return replace(ended, failed=(*rescue.passed, *rescue.failed))


def _parallel(
    walk: Walkthrough, node: controls.Parallel | controls.ParallelAll, scenes: Sequence[Scene]
) -> Outcome:
    """The outcome of children at once: as a rule all of them have to succeed."""
    variables = ports_in(node.scope, node.ports, Scene())
    needs_all = variables is not None and node.needs_all(variables)
    return at_once(walk, node, scenes) if needs_all else walk.unsure(node, scenes)


def _if_then(walk: Walkthrough, node: controls.IfThenElse, scenes: Sequence[Scene]) -> Outcome:
    condition, *branches = node.below
    decided = walk.follow(condition, scenes)
    outcome = Outcome(skipped=decided.skipped, failed=() if len(branches) > 1 else decided.failed)
    for branch, begin in zip(branches, (decided.done, decided.failed), strict=False):
        outcome = outcome.plus_all(walk.follow(branch, begin))
    return outcome


def _switch(walk: Walkthrough, node: controls.Switch, scenes: Sequence[Scene]) -> Outcome:
    outcome = Outcome()
    for chosen, begin in _alike(node, node.ports, scenes, node.chosen):
        walk.doubts += chosen is None
        for child in node.below if chosen is None else [node.below[chosen]]:
            outcome = outcome.plus_all(walk.follow(child, begin))
    return outcome


def _alike(
    node: Node, ports: NodePorts, scenes: Sequence[Scene], read: Callable[[Scope], int]
) -> Iterable[tuple[int | None, list[Scene]]]:
    """The scenes by the value that `read` makes of the node's ports; None where no value is certain."""
    rows: dict[int | None, list[Scene]] = {}
    for scene in scenes:
        variables = ports_in(node.scope, ports, scene)
        rows.setdefault(None if variables is None else read(variables), []).append(scene)
    return rows.items()


def _result(walk: Walkthrough, node: decorators.ResultDecorator, scenes: Sequence[Scene]) -> Outcome:
    after = walk.follow(node.child, scenes)
    outcome = _with(Outcome(skipped=after.skipped), node.ends[SUCCESS], after.done)
    return _with(outcome, node.ends[FAILURE], after.failed)


def _until_failure(
    walk: Walkthrough, node: decorators.KeepRunningUntilFailure, scenes: Sequence[Scene]
) -> Outcome:
    walk.follow(node.child, scenes)
    return Outcome(failed=walk.follow(node.child, walk.blurred(node, scenes)).failed)


def _loop(walk: Walkthrough, node: decorators.Loop, scenes: Sequence[Scene]) -> Outcome:
    outcome = Outcome()
    for most, begin in _alike(node, node.ports, scenes, node.most):
        after = walk.unsure(node, begin) if most is None else _rounds(walk, node, begin, most)
        outcome = outcome.plus_all(after)
    return outcome


def _rounds(walk: Walkthrough, node: decorators.Loop, scenes: Sequence[Scene], most: int) -> Outcome:
    """The outcome of at most so many rounds of a loop; -1 is an endless loop."""
    if most == 0:
        return _with(Outcome(), node.goes_on, scenes)
    if node.goes_on is FAILURE:
        return tried(walk, node.child, scenes, MANY if most < 0 else most)
    after = repeated(walk, node.child, scenes, MANY if most < 0 else most)
    return replace(after, done=()) if most < 0 else after


def _around(walk: Walkthrough, node: Node, scenes: Sequence[Scene]) -> Outcome:
    return walk.follow(node.below[0], scenes)


def _timeout(walk: Walkthrough, node: decorators.Timeout, scenes: Sequence[Scene]) -> Outcome:
    return walk.follow(node.child, scenes).plus(failed=walk.blurred(node, scenes))


def _precondition(walk: Walkthrough, node: decorators.Precondition, scenes: Sequence[Scene]) -> Outcome:
    true, false = _split(walk, node.script, node, scenes)
    after = walk.follow(node.child, true)
    word = node.ports.texts.get("else", "FAILURE")
    if word not in decorators.STATUSES:
        walk.doubts += 1
        return after.plus(done=false, failed=false, skipped=false)
    return _with(after, decorators.STATUSES[word], false)


NODES: Mapping[type[Node], Rule] = {
    Main: _around,
    WrapperNode: _around,
    decorators.SubTree: _around,
    decorators.Delay: _around,
    decorators.Timeout: _timeout,
    decorators.ResultDecorator: _result,
    decorators.KeepRunningUntilFailure: _until_failure,
    decorators.Loop: _loop,
    decorators.Precondition: _precondition,
    controls.InSequence: _sequence,
    controls.InFallback: _sequence,
    controls.SequenceWithMemory: Walkthrough.unsure,
    controls.TryCatch: _try_catch,
    controls.Parallel: _parallel,
    controls.ParallelAll: _parallel,
    controls.IfThenElse: _if_then,
    controls.Switch: _switch,
    leaves.ConstantLeaf: _constant,
    leaves.RunScript: _script,
    leaves.ScriptCondition: _script_condition,
    leaves.SetBlackboard: _set,
    leaves.UnsetBlackboard: _writing,
    leaves.Sleep: lambda walk, node, scenes: Outcome(done=tuple(scenes)),
    leaves.Step: _step,
    DeviceStep: _device,
    FactStep: _facts,
    FunctionNode: _function,
    watching.WasEntryUpdated: Walkthrough.unsure,
}
"""The rule for each class of nodes; a node of another class is unsure."""

RULES: Mapping[type[Behaviour], Rule] = {Node: _node}
