"""A session of the playground: what a person does with time, tasks, verbs and mishaps."""

from __future__ import annotations

import json
from typing import Any

import pytest

from arboleda.geometry import bodies
from arboleda.plant_file.urdf import robot_urdf
from arboleda_class.playground import plants
from arboleda_class.playground.session import Session
from arboleda_proofs.simulator import mishaps

MINUTE = 960  # ticks
TASK = "sis_a 0A 8"


@pytest.fixture(scope="module")
def model() -> Any:
    return plants.model("arboleda")


def session(model: Any, **more: Any) -> Session:
    return Session(model, {}, language="en", **more)


def at_work(model: Any, **more: Any) -> Session:
    """A session in which a task is half done."""
    made = session(model, **more)
    made.take("submit", TASK)
    made.advance(80)
    return made


def state(made: Session) -> str:
    """The state of the first cell, as the page has it in its whole."""
    made.forget()
    return str(made.frame()["face"]["text/sis_a.state"][1])


def board(model: Any, robot: str) -> str:
    return str(model.robots[robot].mqtt)


def test_a_task_is_answered_and_done(model: Any) -> None:
    made = session(model)
    made.take("submit", TASK)
    made.advance(MINUTE)
    assert [good for _, good in made.frame()["said"]] == [True]
    made.forget()
    face = made.frame()["face"]
    assert [row["state"] for key, row in face.items() if key.startswith("row/tasks/")] == ["done"]


def test_a_task_that_nobody_offers_is_refused_with_a_sentence(model: Any) -> None:
    made = session(model)
    made.take("submit", "nowhere 1")
    made.advance(4)
    ((sentence, good),) = made.frame()["said"]
    assert "nowhere" in sentence and good is False


def test_time_in_many_pieces_is_the_same_time(model: Any) -> None:
    whole, pieces = at_work(model), at_work(model)
    whole.advance(400)
    for _ in range(400):
        pieces.advance(1)
    assert whole.digest == pieces.digest


def test_who_goes_back_and_on_sees_the_same_again(model: Any) -> None:
    made = at_work(model, seed=3, level="normal")
    made.befall("reboot", board(model, "ra1"), 0.0)
    made.advance(400)
    digest, stands, tick = made.digest, state(made), made.tick
    made.go(40)
    assert made.tick == 40
    made.go(tick)
    assert (made.digest, state(made), made.tick) == (digest, stands, tick)


def test_another_act_in_the_past_forgets_what_came_after_it(model: Any) -> None:
    made = at_work(model)
    made.befall("reboot", board(model, "ra1"), 0.0)
    made.advance(400)
    made.go(40)
    made.befall("reboot", board(model, "ra2"), 0.0)
    assert made.latest == 40
    made.advance(440)
    assert made.frame()["clock"]["marks"] == [[40, "0:02 ra2: Reboot its board"]]
    assert state(made) == "idle"  # nothing has befallen the first cell


def test_two_acts_at_one_moment_both_happen(model: Any) -> None:
    made = session(model)
    made.take("submit", TASK)
    made.take("submit", "sis_b 0A 8")
    made.advance(8)
    assert len(made.frame()["said"]) == 2


def test_answers_are_not_said_again_by_who_runs_again(model: Any) -> None:
    made = at_work(model)
    made.frame()
    made.go(0)
    made.go(80)
    assert made.frame()["said"] == []


@pytest.mark.long
def test_who_follows_the_advice_gets_a_cell_going_whose_board_has_rebooted(model: Any) -> None:
    made = at_work(model)
    made.befall("reboot", board(model, "ra1"), 0.0)
    made.advance(MINUTE)
    assert state(made) == "held"
    for _ in range(4):
        made.forget()
        face = made.frame()["face"]
        offered = [act for way in face["rows/ways.sis_a"] for act in face[f"row/ways.sis_a/{way}"]["acts"]]
        for act in offered[:1]:
            made.take(act["act"], act["of"], act["by_hand"])
        made.advance(MINUTE)
    assert state(made) == "idle"


def test_a_lasting_mishap_ends_by_itself(model: Any) -> None:
    made = session(model)
    made.befall("cut_link", board(model, "ra1"), 5.0)
    made.advance(64)
    made.forget()
    assert made.frame()["face"]["row/links/ra1"]["state"] == "offline"
    made.advance(160)
    made.forget()
    assert made.frame()["face"]["row/links/ra1"]["state"] != "offline"


def test_what_somebody_has_to_do_at_a_machine_has_a_button(model: Any) -> None:
    made = at_work(model)
    made.befall("no_power", board(model, "ra1"), 60.0)
    made.advance(160)
    made.forget()
    face = made.frame()["face"]
    first = face["rows/happened"][1]
    assert face[f"row/happened/{first}"]["acts"][0]["of"] == first
    made.take("hand", first)
    made.advance(160)
    assert first not in made.frame()["face"].get("rows/happened", [])


def test_steps_go_from_one_happening_to_the_next_and_back_again(model: Any) -> None:
    made = session(model)
    made.take("submit", TASK)
    ticks = []
    for _ in range(5):
        made.step()
        ticks.append(made.tick)
    assert ticks == sorted(set(ticks))
    for tick in [*reversed(ticks[:-1]), 0]:
        made.step_back()
        assert made.tick == tick


def test_a_step_in_which_nothing_happens_takes_a_minute(model: Any) -> None:
    made = session(model)
    made.step()  # the boards come
    made.step()
    tick = made.tick
    made.step()
    assert made.tick - tick == MINUTE


@pytest.mark.parametrize("request_", [("unheard", "of"), ("hand", "unheard of"), ("seen", "")])
def test_what_no_button_asks_for_is_ignored(model: Any, request_: tuple[str, str]) -> None:
    made = session(model)
    made.take(*request_)
    made.befall("unheard", "of", 1.0)
    made.befall("reboot", "nobody", 1.0)
    made.advance(4)
    assert made.frame()["said"] == []
    assert made.frame()["clock"]["marks"] == []


def test_the_twin_is_drawn_for_who_looks(model: Any) -> None:
    drawings = {name: bodies.read(robot_urdf(model, name)) for name in model.robots}
    made = Session(model, drawings, language="en")
    assert made.frame()["twin"] == {}
    made.look(on=True)
    assert "robot/ra1" in made.frame()["twin"]
    made.look(on=False)
    assert made.frame()["twin"] == {}
    assert [robot["name"] for robot in made.scene["robots"]] == list(model.robots)


@pytest.mark.parametrize("plant", ["arboleda", "machine_tending"])
def test_every_mishap_that_is_offered_can_begin_and_end(plant: str) -> None:
    model = plants.model(plant)
    made = session(model)
    offered = [(each["target"], name) for _, each in mishaps.possible(model) for name in each["mishaps"]]
    assert {name for _, name in offered} > {"reboot", "cut_link", "lost_part", "plant_crash"}
    for target, name in offered:
        made.befall(name, target, 1.0)
    made.advance(160)
    assert len(made.frame()["clock"]["marks"]) == len(offered)


def told(made: Session) -> list[str]:
    """The last mishap and what came of it, as the strip tells."""
    made.forget()
    return list(made.frame()["face"]["row/happened/last"]["texts"])


def events(made: Session) -> list[str]:
    """Rows of the time line on faults, the newest first."""
    made.forget()
    rows = [row for key, row in made.frame()["face"].items() if key.startswith("row/events/")]
    return [row["texts"][3] for row in rows if row["texts"][2].startswith("fault")]


def test_a_mishap_that_has_nothing_to_do_says_why(model: Any) -> None:
    made = session(model)
    made.advance(16)
    made.befall("lost_part", board(model, "ra1"), 0.0)
    made.advance(4)
    assert told(made) == ["0:01 ra1: Lose the part", "Nothing to lose now: it holds no part."]
    assert events(made) == ["fault by hand: Lose the part"]


def test_a_mishap_that_waits_says_for_what_and_then_that_it_is_over(model: Any) -> None:
    made = session(model)
    made.befall("no_part", board(model, "ra1"), 5.0)
    made.advance(16)
    assert told(made)[1] == "It waits until the effector grips."
    made.advance(80)
    assert told(made)[1] == "It is over. No task failed, and no cell is held."
    begun = "fault by hand: No part there to take, for 5 s"
    assert events(made) == ["fault by hand is over: No part there to take", begun]


def test_a_cell_whose_step_has_failed_is_said_to_recover_until_its_task_fails(model: Any) -> None:
    made = session(model)
    made.take("submit", TASK)
    made.befall("no_part", board(model, "ra1"), 60.0)
    said = []
    for _ in range(30):
        made.advance(16)
        said.append(told(made)[1])
    waits, recovers, failed = dict.fromkeys(said)
    assert waits == "It waits until the effector grips."
    assert recovers == "sis_a is recovering: a step of its task has failed."
    assert failed.endswith("no piece at pick-up A")


def test_a_mishap_with_an_effect_tells_it_with_what_is_advised(model: Any) -> None:
    made = at_work(model)
    made.befall("reboot", board(model, "ra1"), 0.0)
    made.advance(MINUTE)
    when, did = told(made)
    assert when == "0:05 ra1: Reboot its board" and did.startswith("sis_a ")
    made.forget()
    face = made.frame()["face"]
    advised = face["rows/happened"][1]
    assert face[f"row/happened/{advised}"]["acts"] == face["row/ways.sis_a/0"]["acts"]


def test_a_run_goes_on_in_another_language(model: Any) -> None:
    made = at_work(model, seed=3, level="normal")
    made.befall("reboot", board(model, "ra1"), 0.0)
    made.advance(160)
    made.take("stop", "sis_a")
    made.advance(160)
    made.go(300)
    other = Session(model, {}, language="es", seed=3, level="normal")
    other.go_on(json.loads(json.dumps(made.past)))
    assert (other.digest, other.tick, other.latest) == (made.digest, 300, 400)
    assert other.frame()["said"] == [] and told(other)[0] == "0:05 ra1: Reiniciar su placa"
    for each in (made, other):
        each.advance(100)
    assert other.digest == made.digest


@pytest.mark.parametrize(
    ("begun", "said"),
    [
        ([("opened_effector", "loader")], "Nothing to open now: its effector is open."),
        ([("opened_device", "mill")], "Nothing to take out now: it holds no part."),
        ([("no_power", "loader"), ("reboot", "loader")], "Nothing to break now: its board has no power."),
        ([("jam", "mill")], "It waits for the end of an order."),
        ([("plant_crash", "plant")], "No task has failed, and no cell is held."),
    ],
)
def test_each_mishap_says_why_nothing_or_what_it_waits_for(begun: list[tuple[str, str]], said: str) -> None:
    made = session(plants.model("machine_tending"))
    made.advance(16)
    for name, target in begun:
        made.befall(name, target, 60.0)
    made.advance(16)
    assert told(made)[1] == said
