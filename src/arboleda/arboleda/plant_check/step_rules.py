"""Rules of a walkthrough for the steps of recipes in Python: the outcome of each class of steps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product, zip_longest
from math import prod
from typing import cast

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy
from py_trees.decorators import Decorator

from arboleda.engine import (
    Act,
    Approach,
    Await,
    Leaf,
    Require,
    TakeDevices,
    Unless,
    title_of,
)
from arboleda.kinds.ranges import Range, Wanted, apart, is_so
from arboleda.model.facts import Value, shown
from arboleda.recipes.authoring import FAIL, IS, NO_OTHER
from arboleda.recipes.decorators import Again, AtMost, Forgiven, Inverted, Rescue, Times
from arboleda.recipes.handles import FactCheck, FactWait, Question
from arboleda.recipes.place_questions import PlaceQuestion

from .foresight import AT, HAD, OVER, Scene, SceneKey, common
from .parallel_scenes import Branches
from .walkthrough import (
    MOST_ROUNDS,
    Outcome,
    Rule,
    Walkthrough,
    answer_key,
    asked_by,
    few,
    last_answer,
    last_answer_key,
)

HOME_AGAIN, LEAVE_DEVICES = "step.home_again", "step.leave_devices"  # keys of titles
MOST_MERGED = 64  # scenes of a parallel that are put together one by one


def _leaf(walk: Walkthrough, node: Leaf, scenes: Sequence[Scene]) -> Outcome:
    return Outcome(done=tuple(scenes), failed=tuple(scenes))


def _act(walk: Walkthrough, node: Act, scenes: Sequence[Scene]) -> Outcome:
    walk.check(node, scenes)
    command, answer = node.make(id=""), {answer_key(node), last_answer_key(node)}
    after = (walk.foresight.after(command, scene) for scene in scenes)
    done = tuple(scene.without(answer).put(asked_by(node)) for scene in after)
    return Outcome(done=done, failed=walk.blurred(node, scenes))


def _approach(walk: Walkthrough, node: Approach, scenes: Sequence[Scene]) -> Outcome:
    """The outcome of an approach: where the robot is, the move after the approach says.

    An approach may not be needed, and that move begins where the approach ends.
    """
    return Outcome(done=tuple(scenes), failed=walk.blurred(node, scenes))


def _require(walk: Walkthrough, node: Require, scenes: Sequence[Scene]) -> Outcome:
    never = node.title.key in (FAIL.key, NO_OTHER.key)
    return Outcome(done=() if never else tuple(scenes), failed=tuple(scenes))


def _unless(walk: Walkthrough, node: Unless, scenes: Sequence[Scene]) -> Outcome:
    if node.title.key == IS.key:  # `_chosen` has only the scenes with this answer begin here
        return Outcome(done=tuple(scenes))
    walk.doubts += 1
    return Outcome(done=tuple(scenes), failed=tuple(scenes))


def _await(walk: Walkthrough, node: Await, scenes: Sequence[Scene]) -> Outcome:
    title = title_of(node)
    if title.key != LEAVE_DEVICES:
        return _leaf(walk, node, scenes)
    return walk.given_back(cast("tuple[str, ...]", title.values["devices"]), scenes)


def _take_devices(walk: Walkthrough, node: TakeDevices, scenes: Sequence[Scene]) -> Outcome:
    taken = {(name, HAD): True for name in node.devices}
    return Outcome(done=tuple(scene.put(taken) for scene in scenes), failed=tuple(scenes))


def _fact_check(walk: Walkthrough, node: FactCheck, scenes: Sequence[Scene]) -> Outcome:
    """The outcome of a check of facts: a certain other value fails it."""
    facts = _facts(node)
    possible = [
        each
        for each in scenes
        if all(each.get(*key) is None or is_so(facts[key], each.get(*key)) for key in facts)
    ]
    return _fact_outcome(walk, facts, possible, scenes)


def _fact_wait(walk: Walkthrough, node: FactWait, scenes: Sequence[Scene]) -> Outcome:
    """The outcome of waiting for facts: a certain other value may change by itself meanwhile."""
    return _fact_outcome(walk, _facts(node), scenes, scenes)


def _place_question(walk: Walkthrough, node: PlaceQuestion, scenes: Sequence[Scene]) -> Outcome:
    """The outcome of a question where parts are: an earlier answer does not count."""
    return Outcome(done=tuple(scene.without({answer_key(node)}) for scene in scenes))


def _facts(node: FactCheck | FactWait) -> dict[SceneKey, Wanted]:
    return {(node.device, fact): value for fact, value in node.facts.items()}


def _fact_outcome(
    walk: Walkthrough, facts: Mapping[SceneKey, Wanted], possible: Sequence[Scene], scenes: Sequence[Scene]
) -> Outcome:
    unlike = [scene for scene in scenes if any(not is_so(facts[key], scene.get(*key)) for key in facts)]
    sure = {key: value for key, value in facts.items() if not isinstance(value, Range)}
    walk.doubts += any(scene.get(*key) is None for scene in unlike for key in facts)
    return Outcome(done=tuple(scene.put(sure) for scene in possible), failed=tuple(unlike))


def _sequence(walk: Walkthrough, node: composites.Sequence, scenes: Sequence[Scene]) -> Outcome:
    if not node.memory:
        return walk.unsure(node, scenes)
    outcome = Outcome(done=tuple(scenes))
    for child in node.children:
        after = walk.follow(child, outcome.done)
        outcome = Outcome(done=after.passed, failed=(*outcome.failed, *after.failed))
    return outcome


def _selector(walk: Walkthrough, node: composites.Selector, scenes: Sequence[Scene]) -> Outcome:
    question = getattr(node, "asked", None)
    if question is not None:
        return _chosen(walk, node, question, scenes)
    title = title_of(node)
    if title.key == HOME_AGAIN:
        (robot,) = map(str, title.values.values())
        return _gone_home(walk, node, robot, scenes)
    if not node.memory:
        return walk.unsure(node, scenes)
    outcome = Outcome(failed=tuple(scenes))
    for child in node.children:
        after = walk.follow(child, outcome.failed)
        outcome = Outcome(done=(*outcome.done, *after.passed), failed=after.failed)
    return outcome


def _gone_home(walk: Walkthrough, node: composites.Selector, robot: str, scenes: Sequence[Scene]) -> Outcome:
    """The outcome of going home unless the robot is there: it is at home after both branches."""
    home = walk.foresight.home(robot)
    there = {(robot, AT): home, (robot, OVER): home}
    stays = [scene.put(there) for scene in scenes if scene.get(robot, AT) in (None, home)]
    goes = walk.follow(node.children[-1], [scene for scene in scenes if scene.get(robot, AT) != home])
    return Outcome(done=(*stays, *goes.passed), failed=goes.failed)


def _chosen(
    walk: Walkthrough, node: composites.Selector, question: Question, scenes: Sequence[Scene]
) -> Outcome:
    """The outcome of a choice by an answer: each branch begins in the scenes with its answer.

    It is the last answer of the device where no other step has asked that since.
    """
    outcome, key = Outcome(), answer_key(question)
    asked = asked_by(question)
    for child, answers in _ways(node, question):
        last = _last_answer(question, child)
        here = [(scene, each) for each in answers for scene in scenes if scene.get(*key) in (None, each)]
        begin = [scene.put({key: each, **(last if scene.has(asked) else {})}) for scene, each in here]
        after = walk.follow(child, begin)
        outcome = outcome.plus(done=after.passed, failed=after.failed)
    return outcome


def _ways(node: composites.Selector, question: Question) -> Iterator[tuple[Behaviour, Sequence[Value]]]:
    """Each branch of a choice with the answers that lead to it, as all choices by this question have them.

    Of numbers there is one for each set of ranges that a number has in all these choices.
    """
    ranges: Sequence[Range] = getattr(node, "ranges", ())
    numbers = () if question.number is None else apart(question.number, question.ranges)
    apart_by = {tuple(each.has(number) for each in question.ranges): number for number in numbers}
    for child, its in zip_longest(node.children, ranges):
        yield child, (child.name,) if its is None else tuple(filter(its.has, apart_by.values()))


def _last_answer(question: Question, branch: Behaviour) -> dict[SceneKey, Value]:
    """The last answer of a device where this branch is chosen by it; empty where nobody knows it."""
    answers = (each for each in question.answers if branch.name == shown(each))
    return next((last_answer(question, each) for each in answers), {})


def _parallel(walk: Walkthrough, node: composites.Parallel, scenes: Sequence[Scene]) -> Outcome:
    if not isinstance(node.policy, ParallelPolicy.SuccessOnAll):
        return walk.unsure(node, scenes)
    return at_once(walk, node, scenes)


def at_once(walk: Walkthrough, node: Behaviour, scenes: Sequence[Scene]) -> Outcome:
    """The outcome of steps at the same time that is done once all of the steps are.

    Each step is followed without the values that the other steps may change meanwhile.
    """
    outcome = Outcome(failed=walk.blurred(node, scenes))
    for scene in scenes:
        branches = Branches(walk, node.children, scene)
        outcomes = [walk.follow(child, [branches.begin_of(n)]) for n, child in enumerate(node.children)]
        every = [branches.merged(ends) for ends in _combined([each.passed for each in outcomes])]
        none = [branches.merged(ends) for ends in _combined([each.skipped for each in outcomes])]
        is_none = {each.mark for each in none}
        outcome = outcome.plus(done=[each for each in every if each.mark not in is_none], skipped=none)
    return outcome


def _combined(ends: Sequence[Sequence[Scene]]) -> Iterator[tuple[Scene, ...]]:
    """All combinations of one end of each branch; where these are many, the common scene of each branch."""
    many = prod(map(len, ends)) > MOST_MERGED
    return product(*(common(each) if many else each for each in ends))


def _around(walk: Walkthrough, node: Decorator, scenes: Sequence[Scene]) -> Outcome:
    after = walk.follow(node.decorated, scenes)
    return Outcome(done=after.passed, failed=after.failed)


def _at_most(walk: Walkthrough, node: AtMost, scenes: Sequence[Scene]) -> Outcome:
    after = walk.follow(node.decorated, scenes)
    return Outcome(done=after.passed, failed=walk.blurred(node, scenes))


def _rescue(walk: Walkthrough, node: Rescue, scenes: Sequence[Scene]) -> Outcome:
    after = walk.follow(node.decorated, scenes)
    return Outcome(failed=(*after.passed, *after.failed))


def _inverted(walk: Walkthrough, node: Inverted, scenes: Sequence[Scene]) -> Outcome:
    after = walk.follow(node.decorated, scenes)
    return Outcome(done=after.failed, failed=after.passed)


def _again(walk: Walkthrough, node: Again, scenes: Sequence[Scene]) -> Outcome:
    return tried(walk, node.decorated, scenes, node.times + 1)


def tried(walk: Walkthrough, step: Behaviour, scenes: Sequence[Scene], times: float) -> Outcome:
    """The outcome of a step that is tried again where it failed, from halfway through the step."""
    first = walk.follow(step, scenes)
    if times <= 1:
        return first
    later = walk.follow(step, walk.blurred(step, first.failed))
    return first.plus_all(later)


def _times(walk: Walkthrough, node: Times, scenes: Sequence[Scene]) -> Outcome:
    after = repeated(walk, node.decorated, scenes, node.times)
    return Outcome(done=after.passed, failed=after.failed)


def repeated(walk: Walkthrough, step: Behaviour, scenes: Sequence[Scene], times: int) -> Outcome:
    """The outcome of a step that is done so many times.

    At most MOST_ROUNDS are followed. The last of them stands for all others.
    """
    outcome = Outcome(done=tuple(scenes))
    for number in range(min(times, MOST_ROUNDS)):
        is_last = number + 1 == MOST_ROUNDS < times
        begin = walk.blurred(step, outcome.done) if is_last else outcome.done
        after = walk.follow(step, begin)
        others = outcome.plus(failed=after.failed, skipped=after.skipped)
        outcome = replace(others, done=after.done)
        if few(outcome.done) == few(begin):
            break
    return outcome


RULES: Mapping[type, Rule] = {
    Leaf: _leaf,
    Act: _act,
    Approach: _approach,
    Await: _await,
    TakeDevices: _take_devices,
    Require: _require,
    Unless: _unless,
    FactCheck: _fact_check,
    FactWait: _fact_wait,
    PlaceQuestion: _place_question,
    composites.Sequence: _sequence,
    composites.Selector: _selector,
    composites.Parallel: _parallel,
    Forgiven: _around,
    Again: _again,
    AtMost: _at_most,
    Rescue: _rescue,
    Inverted: _inverted,
    Times: _times,
}
"""The rule for each class of steps; a step of another class is unsure."""
