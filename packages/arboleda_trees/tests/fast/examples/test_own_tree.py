"""The example with a tree as XML: whatever is answered or gives up, the cell works again."""

from __future__ import annotations

from functools import partial

import pytest
from tests.lengths import sample
from tests.unit.kinds import example_trials
from tests.unit.kinds.example_trials import OF_TREES, Case

tree = partial(Case, folder="own_tree")
TAKEN = ("loader to done", "jaw open", "loader to home")
SCRAPPED = ("loader to reject", "jaw open", "loader to home")
CASES = (
    tree(task="cell tend slot_1 1002", ends_with=TAKEN, tries_again=frozenset({("mill", "run")})),
    tree(task="cell tend slot_1 1001", answers={"camera": "bad"}, ends_with=SCRAPPED),
    tree(task="cell tend slot_2 1001", answers={"camera": "unsure"}, ends_with=TAKEN),
    tree(task="cell tend slot_2 1002", answers={"camera": "unsure", "operator": "bad"}, ends_with=SCRAPPED),
)
PLAIN = [each for each in CASES if not each.answers]


@pytest.mark.long
def test_every_recipe_and_every_answer_is_tried() -> None:
    for folder in OF_TREES:
        example_trials.every_answer_is_tried(folder, CASES)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("case", CASES, ids=str)
def test_a_task_ends_as_its_recipe_says_whatever_is_answered(case: Case) -> None:
    example_trials.ends_as_the_recipe_says(case, CASES)


@pytest.mark.sampled(5)
@pytest.mark.parametrize("case", sample(PLAIN, every=1), ids=str)
def test_after_any_device_gave_up_the_first_advice_leads_back_to_work(case: Case) -> None:
    example_trials.works_again_after_a_device_gave_up(case, CASES)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("case", sample(PLAIN, every=1), ids=str)
def test_after_a_stop_at_any_time_the_first_advice_leads_back_to_work(case: Case) -> None:
    example_trials.works_again_after_a_stop(case, CASES)


@pytest.mark.parametrize("folder", OF_TREES)
def test_a_target_is_the_same_place_for_all_arms_and_another_one_than_the_others(folder: str) -> None:
    example_trials.targets_are_places_of_their_own(folder)
