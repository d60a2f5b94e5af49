"""What the bridge says about messages that it refuses: printable, and short, whatever they hold."""

from __future__ import annotations

from hypothesis import example, given
from hypothesis import strategies as st

from arboleda.model.errors import PayloadError
from arboleda.testing import shipped
from arboleda.wire.bridge import Bridge
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
