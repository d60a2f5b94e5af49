"""Strict bytes: a message is taken whole or refused whole, with a sentence that names the field."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.model.commands import StopMode
from arboleda.model.errors import PayloadError
from arboleda.model.messages import MotionState
from arboleda.wire.payloads import (
    REFUSALS,
    Beat,
    EffectorGoal,
    HomeGoal,
    JointsGoal,
    PathGoal,
    Presence,
    StopGoal,
    Telemetry,
    VerbGoal,
    decode,
    encode,
)
from arboleda.wire.strict import LIMIT_BYTES
from arboleda.wire.topics import Channel

UINT = st.integers(0, 2**32 - 1)
ANGLE = st.floats(-1e6, 1e6).map(lambda value: round(value, 4) + 0.0)
NUMBERS = st.one_of(
    st.fixed_dictionaries({"seq": UINT, "epoch": UINT}), st.just({"seq": None, "epoch": None})
)
REFUSED = st.one_of(
    st.fixed_dictionaries({"refusal": st.sampled_from(sorted(REFUSALS)), "refused_seq": UINT}), st.just({})
)


def maybe(values: st.SearchStrategy) -> st.SearchStrategy:
    return st.none() | values


def goals(kind: type, **fields: st.SearchStrategy) -> st.SearchStrategy:
    return st.builds(lambda body, stamp: kind(**body, **stamp), st.fixed_dictionaries(fields), NUMBERS)


def telemetry(q: st.SearchStrategy, node: st.SearchStrategy, *flags: str) -> st.SearchStrategy:
    body = st.fixed_dictionaries(
        {
            "state": st.sampled_from([state for state in MotionState if state is not MotionState.NO_LINK]),
            "q_deg": q,
            "node": node,
            **{name: maybe(UINT) for name in ("seq", "ack_epoch", "least_epoch", "ack", "done", "boot_id")},
            **{name: maybe(st.booleans()) for name in ("homed", *flags)},
        }
    )
    return st.builds(lambda said, refused: Telemetry(**said, **refused), body, REFUSED)


ANGLES = st.tuples(ANGLE, ANGLE, ANGLE)
ARM = {
    Channel.JOINTS: goals(JointsGoal, q_deg=ANGLES),
    Channel.EFFECTOR: goals(EffectorGoal, on=st.booleans()),
    Channel.STOP: goals(StopGoal, mode=st.sampled_from(StopMode)),
    Channel.HOME: goals(HomeGoal),
    Channel.BEAT: st.builds(Beat, epoch=UINT),
    Channel.TELEMETRY: telemetry(ANGLES, st.none(), "effector", "piece"),
    Channel.PRESENCE: st.builds(Presence, online=st.booleans()),
}
MOBILE = {
    Channel.PATH: goals(PathGoal, nodes=st.lists(UINT, min_size=1, max_size=30).map(tuple)),
    Channel.TELEMETRY: telemetry(st.none(), UINT),
}
SPOKEN = [(3, channel, values) for channel, values in ARM.items()] + [
    (None, channel, values) for channel, values in MOBILE.items()
]


@pytest.mark.parametrize(
    ("axes", "channel", "values"), SPOKEN, ids=lambda value: getattr(value, "value", None)
)
@given(data=st.data())
def test_what_is_encoded_is_decoded(
    axes: int | None, channel: Channel, values: st.SearchStrategy, data: st.DataObject
) -> None:
    payload = data.draw(values)
    raw = encode(payload)
    assert len(raw) <= LIMIT_BYTES
    assert decode(channel, raw, axes=axes) == payload


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=5,
)
KEYS = st.sampled_from(
    ["q1", "q2", "q3", "q1_mov", "q2_mov", "q3_mov", "estado", "nodo", "nodos", "seq", "epoca", "paro", "ref"]
) | st.sampled_from(["efector", "pieza", "rechazo", "rechazo_seq", "arranque", "ack", "hecho", "epoca_ack"])
NEARLY = st.dictionaries(KEYS, JSON | st.integers(0, 5)).map(lambda values: json.dumps(values).encode())


@given(st.sampled_from(Channel), st.none() | st.integers(1, 6), st.binary() | NEARLY)
def test_any_bytes_are_a_payload_or_a_payload_error(channel: Channel, axes: int | None, raw: bytes) -> None:
    try:
        payload = decode(channel, raw, axes=axes)
    except PayloadError as error:
        sentence = str(error)
    else:
        sentence = repr(payload)
    assert sentence.isprintable()


ARM_SAYS = '{"q1_mov":1,"q2_mov":2,"q3_mov":3,"estado":0'
REFUSED_WHOLE = [
    ("not an object", Channel.STOP, b"[0]", "object"),
    ("empty", Channel.STOP, b"", "JSON"),
    ("not UTF-8", Channel.STOP, b'{"paro":1,"x":"\xff"}', "UTF-8"),
    ("with a byte order mark", Channel.STOP, b'\xef\xbb\xbf{"paro":1}', "JSON"),
    ("513 bytes", Channel.STOP, b'{"paro":1}'.ljust(513), "513 bytes"),
    ("a key twice", Channel.STOP, b'{"paro":1,"paro":0}', "paro"),
    ("nested", Channel.STOP, b"[" * 512, "JSON"),
    ("a missing joint", Channel.JOINTS, b'{"q1":1,"q2":2}', "q3"),
    ("NaN", Channel.JOINTS, b'{"q1":1,"q2":NaN,"q3":3}', "NaN"),
    ("-Infinity", Channel.JOINTS, b'{"q1":1,"q2":-Infinity,"q3":3}', "-Infinity"),
    ("an overflow", Channel.JOINTS, b'{"q1":1,"q2":1e999,"q3":3}', "q2"),
    ("an endless integer", Channel.JOINTS, b'{"q1":1' + b"0" * 400 + b',"q2":0,"q3":3}', "q1"),
    ("a bool for a number", Channel.JOINTS, b'{"q1":1,"q2":true,"q3":3}', "q2"),
    ("a string for a number", Channel.JOINTS, b'{"q1":"1","q2":2,"q3":3}', "q1"),
    ("null for a number", Channel.JOINTS, b'{"q1":null,"q2":2,"q3":3}', "q1"),
    ("seq alone", Channel.STOP, b'{"paro":1,"seq":3}', "epoca"),
    ("epoca alone", Channel.STOP, b'{"paro":1,"epoca":3}', "seq"),
    ("seq too large", Channel.STOP, b'{"paro":1,"seq":4294967296,"epoca":1}', "seq"),
    ("seq negative", Channel.STOP, b'{"paro":1,"seq":-1,"epoca":1}', "seq"),
    ("seq a float", Channel.STOP, b'{"paro":1,"seq":1.0,"epoca":1}', "seq"),
    ("epoca null", Channel.BEAT, b'{"epoca":null}', "epoca"),
    ("paro 3", Channel.STOP, b'{"paro":3}', "paro"),
    ("paro true", Channel.STOP, b'{"paro":true}', "paro"),
    ("ref 0", Channel.HOME, b'{"ref":0}', "ref"),
    ("efector 2", Channel.EFFECTOR, b'{"efector":2}', "efector"),
    ("estado 255", Channel.TELEMETRY, ARM_SAYS.replace(":0", ":255").encode() + b"}", "estado"),
    ("estado missing", Channel.TELEMETRY, b'{"q1_mov":1,"q2_mov":2,"q3_mov":3}', "estado"),
    ("pieza null", Channel.TELEMETRY, ARM_SAYS.encode() + b',"pieza":null}', "pieza"),
    ("pieza true", Channel.TELEMETRY, ARM_SAYS.encode() + b',"pieza":true}', "pieza"),
    (
        "an unknown word",
        Channel.TELEMETRY,
        ARM_SAYS.encode() + b',"rechazo":"no","rechazo_seq":1}',
        "rechazo",
    ),
    ("a word alone", Channel.TELEMETRY, ARM_SAYS.encode() + b',"rechazo":"paro"}', "rechazo_seq"),
    ("arranque a string", Channel.TELEMETRY, ARM_SAYS.encode() + b',"arranque":"1"}', "arranque"),
    ("presence by word", Channel.PRESENCE, b"true", "conexion"),
    ("presence empty", Channel.PRESENCE, b"", "conexion"),
    ("a path for an arm", Channel.PATH, b'{"nodos":[0,1]}', "path"),
]


@pytest.mark.parametrize(
    ("channel", "raw", "named"), [row[1:] for row in REFUSED_WHOLE], ids=[row[0] for row in REFUSED_WHOLE]
)
def test_a_bad_message_is_refused_by_name(channel: Channel, raw: bytes, named: str) -> None:
    with pytest.raises(PayloadError, match=named):
        decode(channel, raw, axes=3)


@pytest.mark.parametrize("nodes", ["[]", "0", "[0,true]", "[0,1.0]", '[0,"1"]', "[-1]", "{}"])
def test_a_path_is_a_list_of_nodes(nodes: str) -> None:
    with pytest.raises(PayloadError, match="nodos"):
        decode(Channel.PATH, f'{{"nodos":{nodes}}}'.encode(), axes=None)


def test_a_newer_board_may_say_more() -> None:
    said = decode(Channel.TELEMETRY, ARM_SAYS.encode() + b',"temperatura":[40.5]}', axes=3)
    assert said == Telemetry(state=MotionState.STOPPED, q_deg=(1.0, 2.0, 3.0), node=None)


def test_angles_are_told_with_four_decimals_and_no_empty_sign() -> None:
    goal = JointsGoal(q_deg=(44.99999, -0.00001, 12.345678), seq=None, epoch=None)
    assert encode(goal) == b'{"q1":45.0,"q2":0.0,"q3":12.3457}'


CANNOT_BE_SAID = {
    "not a number": JointsGoal(q_deg=(float("nan"), 0.0, 0.0), seq=1, epoch=1),
    "seq without epoca": StopGoal(mode=StopMode.HALT, seq=1, epoch=None),
    "a path longer than a message": PathGoal(nodes=tuple(range(300)), seq=1, epoch=1),
    "no link": Telemetry(state=MotionState.NO_LINK, q_deg=None, node=0),
    "a refusal without its seq": Telemetry(state=MotionState.STOPPED, q_deg=None, node=0, refusal="paro"),
}


@pytest.mark.parametrize("payload", CANNOT_BE_SAID.values(), ids=CANNOT_BE_SAID.keys())
def test_what_no_receiver_would_take_is_not_sent(payload: object) -> None:
    with pytest.raises(PayloadError):
        encode(payload)  # type: ignore[arg-type]


def test_a_token_for_which_there_is_no_room_is_left_out() -> None:
    name = "x" * 32
    values = tuple((f"{number}{name}"[:32], name) for number in range(6))
    goal = VerbGoal(verb="run", values=values, seq=1, epoch=1, token="0a3f9x001a01")
    long = replace(goal, values=(*values, ("last", "x" * 17)))
    assert decode(Channel.ORDER, encode(goal), axes=0) == goal
    assert decode(Channel.ORDER, encode(long), axes=0) == replace(long, token=None)
