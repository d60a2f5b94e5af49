"""Whatever happens in whatever order: no exception, and the promises of the bridge hold."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Home, Stop, StopMode
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Evidence, Robot
from arboleda.wire.payloads import REFUSALS, Beat

SMALL = st.none() | st.integers(0, 6)
EPOCHS = st.sampled_from([None, 0, 999, 1_000, 1_001, 1_002, 2**32 - 1])
ROBOTS = st.sampled_from(["ra1", "rm_sis_a", "nobody"])
BOARDS = st.sampled_from(["ra_1", "rm_sis_a"])
LABELS = st.builds("{}-{}".format, st.integers(6, 8), st.integers(1, 4)) | st.sampled_from(["", "odd"])
COMMANDS = st.one_of(
    st.builds(MoveJoints, id=LABELS, robot=ROBOTS, q=st.tuples(*[st.floats()] * 3)),
    st.builds(FollowPath, id=LABELS, robot=ROBOTS, nodes=st.lists(st.integers(-1, 9), max_size=4).map(tuple)),
    st.builds(SetEffector, id=LABELS, robot=ROBOTS, on=st.booleans()),
    st.builds(Stop, id=LABELS, robot=ROBOTS, mode=st.sampled_from(StopMode)),
    st.builds(Home, id=LABELS, robot=ROBOTS),
)
SAID = st.fixed_dictionaries(
    {
        "state": st.sampled_from([state for state in MotionState if state is not MotionState.NO_LINK]),
        "seq": SMALL,
        "ack_epoch": EPOCHS,
        "ack": SMALL,
        "done": SMALL,
        "boot_id": st.none() | st.integers(1, 2),
    }
)
REFUSED = st.just({"refusal": None, "refused_seq": None}) | st.fixed_dictionaries(
    {"refusal": st.sampled_from(sorted(REFUSALS)), "refused_seq": st.integers(0, 6)}
)
HAPPENINGS = st.one_of(
    st.tuples(st.just("order"), COMMANDS),
    st.tuples(st.just("connect"), st.booleans()),
    st.tuples(st.just("presence"), st.booleans(), BOARDS),
    st.tuples(st.just("heartbeat"), st.integers(6, 8)),
    st.tuples(st.just("wait"), st.sampled_from([0.0, 0.25, 2.0])),
    st.tuples(st.just("deliver"), st.sampled_from(["ra_1/sensores", "ra_1/conexion", "x"]), st.binary()),
    st.builds(lambda board, said, refused: ("tell", board, {**said, **refused}), BOARDS, SAID, REFUSED),
)


@pytest.mark.parametrize("evidence", Evidence, ids=lambda level: level.value)
@given(happenings=st.lists(HAPPENINGS, max_size=30))
def test_the_promises_hold(make_linked, sent, evidence: Evidence, happenings: list) -> None:
    bench = make_linked(evidence=evidence)
    numbered = evidence is Evidence.IDS
    asked: set[str] = set()
    online = {"ra_1": True, "rm_sis_a": True}
    for verb, *rest in happenings:
        if verb == "order":
            asked.add(rest[0].id)
        out = bench.tell(rest[0], **rest[1]) if verb == "tell" else getattr(bench, verb)(*rest)
        for report in out:
            if isinstance(report, Report):
                check_report(report, asked)
                note_link(report, bench.model.robots, online)
        for topic, payload in sent(out):
            assert online[topic.split("/")[0]], "published to a robot without a link"
            assert isinstance(payload, Beat) or (payload.seq is not None) == numbered
        assert bench.bridge.next_deadline is None or bench.bridge.next_deadline > bench.now


def check_report(report: Report, asked: set[str]) -> None:
    """A report names only labelled commands that were asked for, a rejected one with its word."""
    assert {report.accepted, report.done, report.rejected} - {None} <= asked - {""}
    assert (report.rejected is None) == (report.refusal is None)


def note_link(report: Report, robots: dict[str, Robot], online: dict[str, bool]) -> None:
    if report.state is not None and report.robot in robots:
        online[robots[report.robot].mqtt] = report.state is not MotionState.NO_LINK
