"""What the bridge says of messages and commands that it refuses: printable, and short, whatever they hold."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Home
from arboleda.model.errors import PayloadError
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.bridge import Bridge
from arboleda.wire.payloads import REFUSALS
from arboleda.wire.rejections import refused
from arboleda.wire.status import Status, from_status
from arboleda.wire.transport import Delivery

MODEL = shipped()
ANY = st.text(st.characters(exclude_categories=()), max_size=300)
TOPICS = st.one_of(
    ANY, ANY.map(lambda word: f"ra_1/{word}"), st.just("ra_1/sensores"), st.just("ra_1/conexion")
)
PAYLOADS = st.one_of(
    st.binary(max_size=300), ANY.map(lambda word: f'{{"{word}": 1}}'.encode(errors="replace"))
)


def plain(text: str) -> bool:
    return text.isprintable() and len(text) <= 1000


@given(topic=TOPICS, payload=PAYLOADS)
@example(topic="x" * 60_000, payload=b"")
@example(topic="ra_1/" + "\x1b" * 60_000, payload=b"")
def test_of_a_message_on_mqtt(topic: str, payload: bytes) -> None:
    bridge = Bridge(MODEL, epoch=1, now=0.0)
    bridge.step(0.0, [Delivery(at=0.0, topic=topic, payload=payload, retain=False)])
    assert all(plain(str(counters.last)) for counters in bridge.counters.values())


@given(key=st.sampled_from(["state", "accepted", "q", "homed", "boot"]), word=ANY, name=ANY)
@example(key="state", word="1", name="a" * 100_000)
def test_of_a_status_on_ros(key: str, word: str, name: str) -> None:
    robot = MODEL.robots["ra1"]
    for said in ("arboleda: ra1", name):
        try:
            from_status(
                0.0, robot, Status(name=said, hardware_id="ra_1", level=0, message="", values={key: word})
            )
        except PayloadError as error:
            assert plain(str(error))


@pytest.mark.parametrize("word", sorted(REFUSALS))
def test_each_word_of_a_board_is_explained(word: str) -> None:
    robot = StorageLayout(shipped().cells[0]).arm
    said = refused(robot, Home(id="1-1", robot=robot.name), word, "", by_board=True)
    assert said.values["robot"] == robot.name and str(said.values["why"]) not in ("", word)


def test_only_of_a_path_a_mobile_robot_says_that_it_leads_off_the_grid() -> None:
    robot = StorageLayout(shipped().cells[0]).mobile
    commands = (FollowPath(id="1-1", robot=robot.name, nodes=(0, 999)), Home(id="1-2", robot=robot.name))
    said = [str(refused(robot, each, "limite", "", by_board=False)) for each in commands]
    assert [f"0 to {robot.grid.size - 1}" in each for each in said] == [True, False]


@pytest.mark.parametrize(
    ("q", "why"),
    [
        (
            (45.0, 10.0, 0.0),
            "number 1 is 45; allowed: -2.618 to 2.618 rad. Is it in degrees? In rad that is 0.7854",
        ),
        ((0.1, 0.1, 80.0), "number 3 is 80; allowed: 0 to 0.1 m. Is it in mm? In m that is 0.08"),
        ((900.0, 0.0, 0.0), "number 1 is 900; allowed: -2.618 to 2.618 rad"),
        ((0.0, 0.0, -80.0), "number 3 is -80; allowed: 0 to 0.1 m"),
    ],
)
def test_of_a_goal_that_would_be_allowed_in_degrees_or_mm_it_is_asked_if_it_is_that(
    q: tuple[float, ...], why: str
) -> None:
    robot = StorageLayout(shipped().cells[0]).arm
    goal = MoveJoints(id="1-1", robot=robot.name, q=q)
    assert str(refused(robot, goal, "limite", "", by_board=False).values["why"]) == why
