"""What each client of the plant's own broker may do, and what one can take from the others: not much."""

from __future__ import annotations

import pytest

from arboleda.adapters.mqtt_broker import limits
from arboleda.adapters.mqtt_broker.access import ALLOWED, Role
from arboleda.adapters.mqtt_broker.packets import Answer

from .broker_rig import PLANT, USERS, Broker, packet, published, text

ANA, RA_1, RA_2 = (("ana", USERS["ana"]), ("ra_1", USERS["ra_1"]), ("ra_2", USERS["ra_2"]))


@pytest.fixture
def guarded(monkeypatch: pytest.MonkeyPatch) -> Broker:
    return Broker(monkeypatch)


@pytest.fixture
def guests(monkeypatch: pytest.MonkeyPatch) -> Broker:
    """A broker on which nobody needs a password."""
    return Broker(monkeypatch, guests=True)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> Broker:
    """The same for ten connections: three may wait to log in, seven are served."""
    return Broker(monkeypatch, guests=True, most=10)


def test_a_stranger_does_not_disturb_a_board_by_its_client_id(guarded: Broker) -> None:
    plant = guarded.peer("bridge", PLANT, "#")
    board = guarded.peer("ra_1", RA_1, "ra_1/juntas")
    stranger, answer = guarded.asked("ra_1", ("ra_1", "wrong"), will="ra_1/conexion")
    assert (answer, stranger.line.is_over) == (Answer.NOT_AUTHORIZED, True)
    plant.say(published("ra_1/juntas", b"goal"))
    assert [each.payload for each in board.messages()] == [b"goal"]
    assert [each.topic for each in plant.messages()] == ["ra_1/juntas"]


def test_a_board_writes_only_its_own_telemetry_and_presence(guarded: Broker) -> None:
    plant, board = guarded.peer("bridge", PLANT, "#"), guarded.peer("ra_1", RA_1)
    refused = ["ra_1/juntas", "ra_1/paro", "ra_2/sensores", "ra_10/sensores", "rm_a/conexion", "other"]
    for topic in [*refused, "ra_1/conexion", "ra_1/sensores"]:
        board.say(published(topic))
    assert [each.topic for each in plant.messages()] == ["ra_1/conexion", "ra_1/sensores"]


def test_a_board_reads_only_its_own_topics(guarded: Broker) -> None:
    board = guarded.peer("ra_1", RA_1)
    wanted = {"ra_1/juntas": True, "ra_1/#": True, "#": False, "+/juntas": False, "ra_10/juntas": False}
    assert dict(zip(wanted, board.granted(*wanted), strict=True)) == wanted


def test_a_last_will_is_held_to_the_same_rules(guarded: Broker) -> None:
    assert guarded.asked("a", RA_1, will="ra_2/conexion")[1] == Answer.NOT_AUTHORIZED
    assert guarded.asked("b", RA_1, will="ra_1/conexion")[1] == Answer.ACCEPTED


def test_any_other_user_reads_everything_and_writes_nothing(guarded: Broker) -> None:
    plant, ana = guarded.peer("bridge", PLANT, "#"), guarded.peer("screen", ANA, "#")
    ana.say(published("ra_1/juntas"))
    plant.say(published("ra_1/latido", b"beat"))
    assert [each.payload for each in plant.messages()] == [b"beat"]
    assert [each.payload for each in ana.messages()] == [b"beat"]


def test_a_newcomer_gets_no_retained_message_that_it_did_not_ask_for(guests: Broker) -> None:
    guests.peer("one").say(published("ra_1/conexion", b"1", retain=True))
    other, asked = guests.peer("other", None, "ra_2/juntas"), guests.peer("asked")
    asked.say(packet(0x82, b"\0\1" + text("ra_1/conexion") + b"\1"))
    assert [each.retain for each in asked.messages()] == [True]
    assert other.messages() == []


def test_a_silent_board_is_dropped_after_one_and_a_half_keep_alives(guarded: Broker) -> None:
    plant = guarded.peer("bridge", PLANT, "#")
    board = guarded.peer("ra_1", RA_1, will="ra_1/conexion", keep_alive_s=10)
    guarded.time.passes(13.9)  # and a second since it came
    assert not board.line.is_over
    guarded.time.passes(0.2)
    assert board.line.is_over
    assert [(each.topic, each.payload) for each in plant.messages()] == [("ra_1/conexion", b"0")]


def test_who_does_not_log_in_is_cut_off(guarded: Broker) -> None:
    silent = guarded.dialled()
    guarded.time.passes(limits.HELLO_S - 0.1)
    assert not silent.line.is_over
    guarded.time.passes(0.2)
    assert silent.line.is_over


@pytest.mark.parametrize(
    "junk",
    [
        b"\x10\xff\xff\xff\xff\x7f",
        b"\x10\x0c\x00\x04MQTT\x04\x02\x00",
        b"\0\0",
        b"\xff" * 64,
        b"\x30\x05\xff",
    ],
)
def test_garbage_is_one_client_s_end_only(guests: Broker, junk: bytes) -> None:
    board, stranger = guests.peer("ra_1", None, "ra_1/juntas"), guests.dialled()
    stranger.say(junk)
    guests.time.passes(limits.HELLO_S)  # of one packet the end may still come
    assert stranger.line.is_over
    board.say(published("ra_1/juntas", b"fine"))
    assert [each.payload for each in board.messages()] == [b"fine"]


@pytest.mark.parametrize("logged_in", [False, True])
def test_a_huge_packet_ends_its_client_by_its_first_bytes(guarded: Broker, logged_in: bool) -> None:
    big = guarded.peer("big", ANA) if logged_in else guarded.dialled()
    big.say((b"\x30" if logged_in else b"\x10") + b"\x80\x80\x80\x7f")  # a remaining length of 254 MB
    assert big.line.is_over


def test_of_those_that_have_not_logged_in_the_one_that_waits_longest_goes(guarded: Broker) -> None:
    waiting = [guarded.dialled() for _ in range(limits.WAITING + 3)]
    assert [each.line.is_over for each in waiting] == [True] * 3 + [False] * limits.WAITING
    assert guarded.asked("ra_1", RA_1)[1] == Answer.ACCEPTED


def test_idle_clients_make_room_and_those_at_work_stay(few: Broker) -> None:
    board = few.peer("ra_1", None, "ra_1/juntas")
    idle = [few.peer(f"idle {n}") for n in range(40)]
    assert idle[0].line.is_over and not idle[-1].line.is_over
    few.peer("bridge", PLANT).say(published("ra_1/juntas"))
    assert [each.payload for each in board.messages()] == [b"x"]


def test_where_all_are_at_work_a_newcomer_is_told_so_and_the_plant_comes_in(few: Broker) -> None:
    boards = [few.peer(f"board {n}", None, "x") for n in range(7)]
    assert few.asked("late")[1] == Answer.BUSY
    few.peer("bridge", PLANT)
    assert [each.line.is_over for each in boards] == [True] + [False] * 6


def test_a_user_has_a_number_of_connections(guarded: Broker) -> None:
    for number in range(ALLOWED[Role.READER].connections):
        guarded.peer(f"{number}", ANA, "#")
    assert guarded.asked("one more", ANA)[1] == Answer.BUSY
    assert guarded.asked("ra_1", RA_1)[1] == Answer.ACCEPTED


def test_a_client_id_belongs_to_its_user(guarded: Broker) -> None:
    plant, board = guarded.peer("bridge", PLANT), guarded.peer("ra_2", RA_2)
    for login in (ANA, RA_1):
        for id in ("ra_2", "bridge"):
            guarded.peer(id, login)
    assert not plant.line.is_over and not board.line.is_over


def test_a_later_connection_of_the_same_user_takes_the_place_of_the_earlier(guarded: Broker) -> None:
    plant = guarded.peer("bridge", PLANT, "ra_1/conexion")
    first = guarded.peer("ra_1", RA_1, will="ra_1/conexion")
    guarded.peer("ra_1", RA_1).say(published("ra_1/conexion", b"1"))
    assert first.line.is_over
    assert [each.payload for each in plant.messages()] == [b"0", b"1"]


def test_subscriptions_are_limited_for_all_but_the_plant(guarded: Broker) -> None:
    allowed = ALLOWED[Role.READER]
    granted = guarded.peer("ana", ANA).granted(
        *(f"+/{n}" for n in range(20)), *(f"t/{n}" for n in range(100))
    )
    assert granted.count(True) == allowed.filters
    assert granted[:20].count(True) == allowed.wildcards
    assert all(guarded.peer("bridge", PLANT).granted(*(f"r{n}/x" for n in range(300))))


def test_a_client_that_reads_nothing_is_cut_off_and_the_others_hear_on(guests: Broker) -> None:
    deaf, hears = guests.peer("deaf", None, "#"), guests.peer("hears", None, "x")
    deaf.line.is_deaf = True
    loud = guests.peer("loud", PLANT)
    for _ in range(limits.UNSENT_BYTES // 3000 + 1):
        loud.say(published("x", b"x" * 3000))
    assert deaf.line.is_over and len(deaf.line.written) <= limits.UNSENT_BYTES
    assert len(hears.messages()) == limits.UNSENT_BYTES // 3000 + 1


def test_of_a_flood_the_plant_gets_what_one_board_may_say(guarded: Broker) -> None:
    plant, board = guarded.peer("bridge", PLANT, "ra_2/sensores"), guarded.peer("ra_2", RA_2)
    rate = int(ALLOWED[Role.BOARD].rate)
    board.say(published("ra_2/sensores") * 10 * rate)
    assert len(plant.messages()) == rate + 1
    guarded.time.passes(1.0)
    assert len(plant.messages()) == pytest.approx(rate, abs=1)
    assert not board.line.is_over


def test_a_message_of_qos_2_comes_once(guests: Broker) -> None:
    hears, raw = guests.peer("hears", None, "x"), guests.peer("raw")
    publish = published("x", b"!", qos=2, number=5)
    raw.say(publish + publish.replace(b"\x34", b"\x3c", 1))
    assert raw.line.written == b"\x50\2\0\5" * 2
    assert len(hears.messages()) == 1
    raw.say(b"\x62\2\0\5" + publish)
    assert len(hears.messages()) == 1
