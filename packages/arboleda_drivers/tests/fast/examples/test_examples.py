"""Examples whose devices have drivers of makers: whatever is answered or gives up, the cell works again."""

from __future__ import annotations

import pytest
from tests.lengths import sample
from tests.unit.kinds import example_trials
from tests.unit.kinds.example_trials import OF_DRIVERS, Case, arms
from tests.unit.kinds.test_led_out import assert_led_out

STORED = ("cart to store", "bed drop", "cart to home")
CASES = (
    Case(folder="agv", task="hall fetch left right", ends_with=("forks drop", "cart to home")),
    Case(folder="agv", task="hall fetch left right", answers={"forks": "empty"}, why="nothing stood there"),
    Case(folder="mixed", task="line deliver slot_1 200", ends_with=STORED),
    Case(folder="mixed", task="line deliver slot_2 400", answers={"belt": "bad"}, ends_with=STORED),
    Case(
        folder="mixed",
        task="line deliver slot_2 100",
        answers={"belt": "bad", "operator": "no"},
        why="the part is bad",
    ),
    Case(folder="nav2", task="hall round left right", ends_with=("cart to right", "cart to home")),
    Case(folder="plc_conveyor", task="line pass 200", ends_with=("belt gate", "belt scan")),
    Case(folder="plc_conveyor", task="line pass 400", answers={"belt": "bad"}, why="the part is bad"),
    Case(
        folder="ros2_control",
        task="bench carry slot_1 slot_2",
        ends_with=("jaw open", "arm to home"),
        is_so=frozenset({("jaw", "open")}),
    ),
)
PLAIN = [each for each in CASES if not each.answers]
WITH_DEVICES = [each for each in PLAIN if each.folder != "nav2"]
WITH_ARMS = ("mixed", "ros2_control")


@pytest.mark.long
def test_every_recipe_of_every_example_and_every_answer_is_tried() -> None:
    assert {case.folder for case in CASES} == set(OF_DRIVERS)
    for folder in OF_DRIVERS:
        example_trials.every_answer_is_tried(folder, CASES)


@pytest.mark.sampled(16)
@pytest.mark.parametrize("case", CASES, ids=str)
def test_a_task_ends_as_its_recipe_says_whatever_is_answered(case: Case) -> None:
    example_trials.ends_as_the_recipe_says(case, CASES)


@pytest.mark.sampled(5)
@pytest.mark.parametrize("case", sample(WITH_DEVICES, every=2), ids=str)
def test_after_any_device_gave_up_the_first_advice_leads_back_to_work(case: Case) -> None:
    example_trials.works_again_after_a_device_gave_up(case, CASES)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("case", sample(PLAIN, every=2), ids=str)
def test_after_a_stop_at_any_time_the_first_advice_leads_back_to_work(case: Case) -> None:
    example_trials.works_again_after_a_stop(case, CASES)


def test_the_examples_with_arms_that_reach_targets_are_these() -> None:
    assert [each for each in OF_DRIVERS if arms(each)] == list(WITH_ARMS)


@pytest.mark.parametrize("folder", WITH_ARMS)
def test_a_target_is_the_same_place_for_all_arms_and_another_one_than_the_others(folder: str) -> None:
    example_trials.targets_are_places_of_their_own(folder)


@pytest.mark.long
@pytest.mark.timeout(900)
@pytest.mark.parametrize("case", PLAIN, ids=str)
def test_a_stop_in_any_verb_and_a_reboot_are_led_out_of_by_buttons_alone(case: Case) -> None:
    assert_led_out(case, CASES)
