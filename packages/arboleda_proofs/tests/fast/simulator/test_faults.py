"""Every kind of fault: that its begin has the effect, and its end undoes it, however many overlap."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest

from arboleda.core.plant import HEARTBEAT_S
from arboleda.model.errors import PayloadError
from arboleda.model.messages import Heartbeat, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig.world import BRIDGE, PLANT, World
from arboleda.testing import shipped
from arboleda.wire.payloads import decode
from arboleda.wire.topics import Channel
from arboleda.wire.transport import Delivery
from arboleda_proofs.simulator.chance import Dice
from arboleda_proofs.simulator.faults import KINDS, OF_CRASHES, OF_DEVICES, OF_HOSTS, ON_ONE_HOST, Fault
from arboleda_proofs.simulator.faults.foreigners import GARBAGE
from arboleda_proofs.simulator.faults.operators import SAID
from arboleda_proofs.simulator.faults.orchestrators import LATEST

LOOK_S = 1.0


def world_of(**declared: Any) -> World:
    """A cell at rest whose boards have obeyed something."""
    world = World(shipped("sis_a", **declared))
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET, Verb.RESUME):
        world.advance(0.3)
        world.request_verb(verb)
    world.advance(0.3)
    return world


def fault(kind: str, target: str, *, seed: int = 1, **rest: Any) -> Fault:
    return Fault(kind=kind, at=0.0, target=target, seed=seed, **rest)


def begin(world: World, fault: Fault) -> Any:
    end = KINDS[fault.kind].begin(world, fault)
    world.settle()
    return end


def delivered(world: World, client: str, topic: str, seconds: float = LOOK_S) -> list[Delivery]:
    """Messages that reach a client on a topic meanwhile."""
    heard: list[Delivery] = []

    def look() -> None:
        heard.extend(each for name, each in world.moment.delivered if (name, each.topic) == (client, topic))

    world.watchers.append(look)
    world.advance(seconds)
    world.watchers.remove(look)
    return heard


def told(world: World, board: str, key: str) -> list[Any]:
    """The values of a field of a board's telemetry as the bridge hears them."""
    said = [json.loads(each.payload) for each in delivered(world, BRIDGE, f"{board}/sensores")]
    return [each.get(key) for each in said]


def speaks(board: str) -> Callable[[World], Any]:
    return lambda world: bool(delivered(world, BRIDGE, f"{board}/sensores"))


def tells(board: str, key: str) -> Callable[[World], Any]:
    """The different values of a field."""
    return lambda world: sorted(set(told(world, board, key)))


def counts(board: str) -> Callable[[World], Any]:
    """True if every telemetry message has its own number, one above the last."""

    def look(world: World) -> bool:
        seqs = told(world, board, "seq")
        return seqs == list(range(seqs[0], seqs[0] + len(seqs)))

    return look


def readable(world: World) -> bool:
    raws = [each.payload for each in delivered(world, BRIDGE, "ra_1/sensores")]
    try:
        return all(decode(Channel.TELEMETRY, raw, axes=3) for raw in raws)
    except PayloadError:
        return False


def reports(world: World) -> bool:
    """True if the plant hears of anybody."""
    return bool(happened(world, "reports"))


def beats(world: World) -> bool:
    """True if the plant says anything."""
    return bool(happened(world, "sent"))


def happened(world: World, what: str) -> list[Any]:
    """Content of that list of the moments meanwhile."""
    found: list[Any] = []

    def look() -> None:
        found.extend(getattr(world.moment, what))

    world.watchers.append(look)
    world.advance(LOOK_S)
    world.watchers.remove(look)
    return found


def hears_retained(world: World) -> bool:
    """True if the bridge takes anything in that its broker kept."""
    events = [event for passed in happened(world, "bridged") for event in passed.events]
    return any(getattr(event, "retain", False) for event in events)


def lateness(world: World) -> float:
    """Greatest delay with which the bridge hears the arm's telemetry, s."""
    said: dict[bytes, float] = {}
    late: list[float] = []

    def look() -> None:
        for _, each in world.moment.published:
            said.setdefault(each.payload, world.now)
        late.extend(
            world.now - said[each.payload]
            for name, each in world.moment.delivered
            if (name, each.topic) == (BRIDGE, "ra_1/sensores") and each.payload in said
        )

    world.watchers.append(look)
    world.advance(LOOK_S)
    world.watchers.remove(look)
    return round(max(late, default=-1.0), 3)


def in_time(world: World) -> bool:
    """True if the plant's heartbeats reach the bridge as regularly as they leave."""
    times: list[float] = []

    def look() -> None:
        times.extend(world.now for each in world.moment.taken if isinstance(each.message, Heartbeat))

    world.watchers.append(look)
    world.advance(LOOK_S)
    world.watchers.remove(look)
    return {round(later - sooner, 6) for sooner, later in pairwise(times)} == {HEARTBEAT_S}


def attribute(name: str) -> Callable[[World], Any]:
    return lambda world: getattr(world.boards["ra_1"].body, name)


LASTING: dict[str, tuple[dict[str, Any], Callable[[World], Any], Any]] = {
    "brown_out": ({"target": "ra_1"}, lambda world: world.is_on("ra_1"), False),
    "mute": ({"target": "ra_1"}, speaks("ra_1"), False),
    "board_stall": ({"target": "ra_1"}, speaks("ra_1"), False),
    "driver_alarm": ({"target": "ra_1"}, tells("ra_1", "estado"), [2]),
    "stuck_bit": ({"target": "ra_1", "word": "seq"}, counts("ra_1"), False),
    "lying_telemetry": ({"target": "ra_1", "word": "ref"}, tells("ra_1", "ref"), [0]),
    "garbled_telemetry": ({"target": "ra_1", "word": "half", "amount": 1.0}, readable, False),
    "no_grip": ({"target": "ra_1"}, attribute("grips"), False),
    "stuck_effector": ({"target": "ra_1"}, attribute("stuck"), True),
    "no_part": ({"target": "ra_1"}, attribute("supplied"), False),
    "piece_false": ({"target": "ra_1", "word": "a piece"}, tells("ra_1", "pieza"), [1]),
    "piece_flicker": ({"target": "ra_1", "amount": 0.5}, tells("ra_1", "pieza"), [0, 1]),
    "loss": ({"target": "ra_1", "word": "up", "amount": 1.0}, speaks("ra_1"), False),
    "duplicate": ({"target": BRIDGE, "word": "down", "amount": 1.0}, counts("ra_1"), False),
    "reorder": ({"target": "ra_1", "word": "up", "amount": 0.5}, counts("ra_1"), False),
    "delay": ({"target": "ra_1", "word": "up", "amount": 0.25}, lateness, 0.25),
    "partition": ({"target": "ra_1", "word": "up, lost"}, speaks("ra_1"), False),
    "hop_delay": ({"target": PLANT, "word": "to plant", "amount": 5.0}, reports, False),
    "hop_reorder": ({"target": PLANT, "word": "to bridge", "amount": 0.5}, in_time, False),
    "hop_partition": ({"target": PLANT, "word": "to plant, lost"}, reports, False),
    "broker_restart": ({"target": "broker"}, lambda world: world.broker.is_up, False),
    "lost_queue": ({"target": BRIDGE}, speaks("ra_1"), False),
    "bridge_restart": ({"target": BRIDGE}, lambda world: world.bridge is not None, False),
    "bridge_stall": ({"target": BRIDGE}, reports, False),
    "plant_stall": ({"target": PLANT}, beats, False),
    "plant_freeze": ({"target": PLANT, "word": "machine", "amount": 3600.0}, beats, False),
    "foreign_repeat": ({"target": "ra_1"}, hears_retained, True),
    "foreign_retained": (
        {"target": "ra_1", "word": "move"},
        lambda world: "ra_1/juntas" in world.broker.retained,
        True,
    ),
}
CALM_S = 6.0  # for what was late, and for links that were down


@pytest.fixture
def world():
    return world_of()


def both(kind: str) -> tuple[list[Fault], Callable[[World], Any], Any]:
    fields, seen, expected = LASTING[kind]
    return [fault(kind, seconds=100.0, seed=seed, **fields) for seed in (1, 2)], seen, expected


def is_clean(world: World) -> bool:
    """True if no fault has left anything behind."""
    lines = [line for client in world.broker.clients.values() for line in (client.up, client.down)]
    troubled = any(line.troubles or line.reorders for line in [*lines, world.to_bridge, world.to_plant])
    stalled = any(world.is_stalled(name) for name in (PLANT, *world.broker.clients))
    gone = not all(world.is_on(name) for name in world.broker.clients) or not world.broker.is_up
    strange = any(not topic.endswith("/conexion") for topic in world.broker.retained)
    kept = any(world.holds.values()) or any(world.deceptions.values()) or world.carriers
    return not (troubled or stalled or gone or strange or kept)


@pytest.mark.parametrize("kind", LASTING)
def test_a_lasting_fault_has_its_effect_until_it_ends(world, kind):
    (one, _), seen, expected = both(kind)
    before = seen(world)
    assert before != expected
    end = begin(world, one)
    assert seen(world) == expected
    end()
    world.advance(CALM_S)
    assert seen(world) == before
    assert is_clean(world)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("first", [0, 1], ids=["the first ends first", "the last ends first"])
@pytest.mark.parametrize("kind", LASTING)
def test_two_at_once_have_their_effect_until_both_have_ended(world, kind, first):
    faults, seen, _ = both(kind)
    before = seen(world)
    ends = [begin(world, each) for each in faults]
    ends.pop(first)()
    world.advance(0.1)
    assert seen(world) != before
    ends.pop()()
    world.advance(CALM_S)
    assert seen(world) == before
    assert is_clean(world)


def test_every_kind_is_in_one_of_the_tables():
    instants = {
        *(f"operator_{verb.value}" for verb in SAID),
        "reboot",
        "lost_steps",
        "lost_part",
        "opened_effector",
        "plant_crash",
        "crash_in_step",
        "power_cut",
        "full_disk",
        "slow_disk",
        "second_orchestrator",
        "foreign_beat",
        "foreign_command",
        "double_submit",
        "bad_task",
        "flood_of_tasks",
        "teach",
        "foreign_garbage",
        "foreign_report",
        "foreign_stray",
        "foreign_old",
        "foreign_halt",
    }
    assert instants | set(LASTING) | set(OF_DEVICES) | set(OF_HOSTS) == set(KINDS)
    assert not instants & set(LASTING)


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda kind: kind.name)
def test_a_kind_says_in_one_sentence_what_it_is(kind):
    assert kind.sentence.endswith(".")
    assert "\n" not in kind.sentence
    assert kind.name == kind.name.lower()


@pytest.mark.sampled(3)
@pytest.mark.parametrize("evidence", Evidence)
@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda kind: kind.name)
def test_what_is_drawn_is_legal(kind, evidence):
    model, dice = shipped(evidence=evidence), Dice(1, kind.name)
    for _ in range(20 if kind.targets(model) else 0):
        drawn = Fault(kind=kind.name, at=0.0, seed=dice.below(99), **kind.draw(dice, model))
        assert kind.objection(drawn, model) is None
        assert kind.seconds[0] <= drawn.seconds <= kind.seconds[1]
        assert kind.amount[0] <= drawn.amount <= kind.amount[1]


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"target": "ra_9"}, "mute cannot befall 'ra_9'; allowed: 'ra_1', 'rm_sis_a'"),
        ({"target": "ra_1", "word": "up"}, "mute of 'ra_1' knows no 'up'; allowed: ''"),
        ({"target": "ra_1", "seconds": -1.0}, "mute: at and seconds are 0 or more"),
    ],
)
def test_an_illegal_fault_is_told_what_is_allowed(wrong, sentence):
    assert KINDS["mute"].objection(Fault(kind="mute", at=0.0, **wrong), shipped("sis_a")) == sentence


@pytest.mark.sampled(3)
@pytest.mark.parametrize("evidence", Evidence)
@pytest.mark.parametrize("seed", range(2))
def test_everything_at_once_leaves_nothing_behind(evidence, seed):
    world, ends = world_of(evidence=evidence), []
    dice = Dice(seed, "everything")
    for number, kind in enumerate(ON_ONE_HOST.values()):
        if kind.targets(world.model):
            drawn = Fault(kind=kind.name, at=0.0, seed=number, **kind.draw(dice, world.model))
            ends.append(begin(world, drawn))
            world.advance(0.05)
    for end in filter(None, ends):
        end()
        world.advance(0.05)
    world.advance(CALM_S + 15.0)
    assert is_clean(world)


@pytest.mark.parametrize(("word", "wills"), [("will", [b"0", b"1"]), ("no will", [b"1"])])
def test_a_reboot_is_another_boot(world, word, wills):
    boot_id = world.boards["ra_1"].boot_id
    log = []
    world.watchers.append(
        lambda: log.extend(each for _, each in world.moment.published if each.topic == "ra_1/conexion")
    )
    assert begin(world, fault("reboot", "ra_1", word=word)) is None
    world.advance(15.0)
    assert world.boards["ra_1"].boot_id > boot_id
    assert [each.payload for each in log] == wills


def test_a_board_without_power_does_not_reboot(world):
    begin(world, fault("brown_out", "ra_1", seconds=5.0))
    begin(world, fault("reboot", "ra_1", word="will"))
    assert not world.is_on("ra_1")


@pytest.mark.parametrize(("amount", "steps"), [(12.4, 12), (-50.0, -50), (0.2, 1)])
def test_lost_steps_move_the_arm_and_not_its_counter(world, amount, steps):
    body = world.boards["ra_1"].body
    counted, true = body.motors.position, body.motors.true_position
    begin(world, fault("lost_steps", "ra_1", word="q2", amount=amount))
    assert body.motors.position == counted
    assert body.motors.true_position == (true[0], true[1] + steps, true[2])


def test_a_lost_part_is_gone(world):
    body = world.boards["ra_1"].body
    body.holding = True
    begin(world, fault("lost_part", "ra_1"))
    assert not body.holding


def test_a_crashed_plant_is_another_plant(world):
    epoch = world.plant.epoch
    begin(world, fault("plant_crash", PLANT))
    assert world.plant.epoch > epoch


def test_a_plant_crashes_only_at_the_level_that_is_made_for_that():
    for name in OF_CRASHES:
        assert KINDS[name].weight == 0


@pytest.mark.parametrize("board", ["ra_1", "rm_sis_a"])
@pytest.mark.parametrize("kind", ["stuck_bit", "lying_telemetry"])
def test_every_field_can_stick_or_lie_and_is_not_to_be_believed(board, kind):
    model = shipped("sis_a")
    about = {"q1_mov": "q", "nodo": "node", "estado": "state", "hecho": "done", "arranque": "boot"}
    for word in KINDS[kind].words(model, board):
        world = World(model)
        end = begin(world, fault(kind, board, word=word, amount=5.0))
        world.advance(0.3)
        assert world.deceptions
        assert all(each == board for each, _ in world.deceptions)
        assert word not in about or (board, about[word]) in world.deceptions
        end()
        world.advance(0.3)
        assert world.deceptions, "what was heard last is still believed"
        world.advance(2.0)
        assert not world.deceptions


@pytest.mark.parametrize("word", ["q1_mov", "estado", "hecho", "ack", "arranque", "seq", "efector"])
def test_a_lie_is_not_the_truth(world, word):
    truth = set(told(world, "ra_1", word))
    end = begin(world, fault("lying_telemetry", "ra_1", word=word, amount=5.0, seed=3))
    lies = told(world, "ra_1", word)
    if word == "seq":
        assert len(set(lies)) < len(lies)
    else:
        assert not truth & set(lies)
    end()


def test_a_joint_is_told_off_by_more_than_its_tolerance(world):
    arm = world.model.robots["ra1"]
    (truth,) = set(told(world, "ra_1", "q3_mov"))
    begin(world, fault("lying_telemetry", "ra_1", word="q3_mov", amount=2.0))
    (lie,) = set(told(world, "ra_1", "q3_mov"))
    off_m = abs(lie - truth) * 3.14159265 / 180 * arm.joints[2].pinion_radius_m
    assert off_m == pytest.approx(2 * arm.motion.tolerances[2], rel=0.01)


@pytest.mark.parametrize("word", ["half", "no number", "a truth value", "too long", "incomplete"])
@pytest.mark.parametrize("board", ["ra_1", "rm_sis_a"])
def test_garbled_telemetry_is_refused_whole(world, board, word):
    begin(world, fault("garbled_telemetry", board, word=word, amount=1.0))
    raws = [each.payload for each in delivered(world, BRIDGE, f"{board}/sensores")]
    assert len(raws) >= 9
    for raw in raws:
        with pytest.raises(PayloadError):
            decode(Channel.TELEMETRY, raw, axes=3 if board == "ra_1" else None)


@pytest.mark.parametrize("kind", ["loss", "duplicate", "garbled_telemetry", "piece_flicker"])
def test_a_share_is_about_that_share(world, kind):
    fields = dict(LASTING[kind][0], amount=0.3)
    plain = len(delivered(world, BRIDGE, "ra_1/sensores", 30.0))
    begin(world, fault(kind, **fields))
    heard = [each.payload for each in delivered(world, BRIDGE, "ra_1/sensores", 30.0)]
    hit = {
        "loss": plain - len(heard),
        "duplicate": len(heard) - plain,
        "garbled_telemetry": sum(not each.endswith(b"}") for each in heard),
        "piece_flicker": sum(b'"pieza":1' in each for each in heard),
    }[kind]
    assert 0.2 < hit / plain < 0.4


@pytest.mark.parametrize("kind", ["mute", "loss", "partition", "lost_queue", "reorder"])
def test_presence_is_neither_lost_nor_overtaken(world, kind):
    fields, _, _ = LASTING[kind]
    ends = [
        begin(world, fault(kind, **{**fields, "target": name, "seconds": 5.0})) for name in ("ra_1", BRIDGE)
    ]
    begin(world, fault("reboot", "ra_1", word="will"))
    for end in ends:
        end()
    world.advance(2.0)
    assert world.plant.dispatcher.beliefs["ra1"].online


def test_what_a_partition_holds_comes_when_it_ends(world):
    end = begin(world, fault("partition", "ra_1", word="up, held", seconds=0.5))
    assert delivered(world, BRIDGE, "ra_1/sensores", 0.49) == []
    world.at(world.now + 0.01, lambda _: end())
    assert len(delivered(world, BRIDGE, "ra_1/sensores", 0.05)) >= 4


def test_a_lost_queue_takes_what_was_under_way(world):
    begin(world, fault("delay", BRIDGE, word="down", amount=2.0))
    world.advance(1.0)
    end = begin(world, fault("lost_queue", BRIDGE))
    end()
    assert delivered(world, BRIDGE, "ra_1/sensores", 1.9) == []


def orders(world: World, fault: Fault, seconds: float = 0.5) -> list[Any]:
    """Orders that the boards carry out after a fault."""
    done: list[Any] = []

    def look() -> None:
        done.extend(world.moment.executed)

    world.watchers.append(look)
    begin(world, fault)
    world.advance(seconds)
    world.watchers.remove(look)
    return done


@pytest.mark.parametrize(
    ("robot", "word"),
    [(robot, word) for robot in ("ra1", "rm_sis_a") for word in ("home", "clear", "beat")]
    + [("ra1", "move"), ("ra1", "effector on"), ("ra1", "effector off"), ("rm_sis_a", "path")],
)
def test_a_superseded_orchestrator_has_no_say(world, robot, word):
    assert orders(world, fault("second_orchestrator", robot, word=word)) == []
    assert world.bridge.counters[robot].refused == (word != "beat")


def test_an_orchestrator_is_superseded_only_by_a_start_that_the_bridge_has_heard(world):
    world.to_bridge.troubles.append(lambda each: ())
    for _ in range(LATEST + 1):
        world.crash(PLANT)
        world.advance(0.1)
    assert world.plant.epoch - LATEST > world.epoch_at_bridge
    assert orders(world, fault("second_orchestrator", "ra1", word="move")) == []
    assert world.bridge.counters["ra1"].refused == 1


def test_an_orchestrator_whose_beat_a_new_bridge_takes_for_its_plant_is_superseded_by_it(world):
    world.plant_process.stop()
    world.crash(BRIDGE)
    assert orders(world, fault("second_orchestrator", "ra1", word="beat"), 0.1) == []
    assert orders(world, fault("second_orchestrator", "ra1", word="move"), 0.1) == []
    assert world.bridge.counters["ra1"].refused == 1


def test_a_frozen_plant_finds_that_a_day_has_passed_and_everything_else_comes_so_much_later(world):
    came = []
    world.at(world.now + 30.0, lambda _: came.append(world.now))
    began = world.now
    end = begin(world, fault("plant_freeze", PLANT, word="machine", seconds=5.0, amount=86_000.0))
    world.advance(4.9)
    end()
    assert happened(world, "sent")[0].seconds == pytest.approx(86_004.9, abs=0.3)
    world.advance(30.0)
    assert came == [pytest.approx(began + 86_030.0)]


def test_what_a_partition_holds_is_held_until_its_end_though_a_day_passes_meanwhile(world):
    end = begin(world, fault("hop_partition", PLANT, word="to bridge, held", seconds=8.0))
    thaw = begin(world, fault("plant_freeze", PLANT, seconds=3.0, amount=80_000.0))
    world.advance(3.0)
    thaw()
    world.advance(4.9 - LOOK_S)
    assert not happened(world, "taken")
    world.advance(0.2)
    end()
    assert happened(world, "taken")


@pytest.mark.parametrize(
    ("robot", "word"),
    [(robot, word) for robot in ("ra1", "rm_sis_a") for word in ("home", "clear")]
    + [("ra1", "move"), ("ra1", "effector on"), ("ra1", "effector off"), ("rm_sis_a", "path")],
)
def test_a_node_of_somebody_else_has_no_say_while_the_plant_is_heard(world, robot, word):
    world.advance(1.0)
    assert orders(world, fault("foreign_command", robot, word=word)) == []
    assert world.bridge.counters[robot].refused == 1
    (noticed,) = world.plant.dispatcher.interference.noticed
    assert "/stranger was refused (foreign)" in str(noticed.sentence)


def test_a_stop_of_somebody_else_counts_and_is_told_of(world):
    world.advance(1.0)
    assert len(orders(world, fault("foreign_command", "ra1", word="stop"))) == 1
    (noticed,) = world.plant.dispatcher.interference.noticed
    assert str(noticed.sentence) == "ra1: stop_cmd 1 of /stranger was obeyed"


def test_nobody_foreign_commands_a_bridge_that_hears_no_plant(world):
    world.stop_bridge()
    world.start_bridge()
    assert orders(world, fault("foreign_command", "ra1", word="home"), 0.1) == []
    assert world.bridge.counters["ra1"].refused == 0


@pytest.mark.parametrize(("word", "state"), [("stop", "STOP_LATCHED"), ("halt", "STOPPED")])
def test_a_stop_counts_whoever_says_it(world, word, state):
    assert len(orders(world, fault("second_orchestrator", "ra1", word=word))) == 1
    assert world.boards["ra_1"].state.name == state


@pytest.mark.parametrize("board", ["ra_1", "rm_sis_a"])
@pytest.mark.parametrize(
    "kind", ["foreign_garbage", "foreign_report", "foreign_stray", "foreign_retained", "foreign_old"]
)
def test_nothing_that_strangers_publish_is_carried_out(world, kind, board):
    for word in dict.fromkeys(KINDS[kind].words(world.model, board)):
        for seed in range(10):
            assert orders(world, fault(kind, board, word=word, seed=seed), 0.01) == []


@pytest.mark.parametrize("board", ["ra_1", "rm_sis_a"])
def test_what_a_kind_of_robot_cannot_say_is_refused_and_believed_by_nobody(world, board):
    robot = {"ra_1": "ra1", "rm_sis_a": "rm_sis_a"}[board]
    foreign = dict.fromkeys(KINDS["foreign_report"].words(world.model, board))
    reports = world.plant.dispatcher.beliefs[robot].reports
    for count, word in enumerate(foreign, start=1):
        begin(world, fault("foreign_report", board, word=word))
        world.settle()
        assert world.bridge.counters[robot].refused == count
        assert word in str(world.bridge.counters[robot].last)
    assert world.plant.dispatcher.beliefs[robot].reports == reports


def test_strangers_leave_a_board_alone_that_has_heard_nothing():
    world = World(shipped("sis_a"))
    for kind, word in (("foreign_old", "move"), ("foreign_retained", "move"), ("foreign_halt", "")):
        said = []
        world.watchers.append(lambda said=said: said.extend(world.moment.published))
        begin(world, fault(kind, "ra_1", word=word))
        assert [sender for sender, _ in said if not sender] == []


def test_a_retained_command_is_refused_at_the_next_connection(world):
    begin(world, fault("foreign_retained", "ra_1", word="effector on", seconds=50.0))
    assert orders(world, fault("reboot", "ra_1", word="will")) == []
    assert "retenido" in str(delivered(world, BRIDGE, "ra_1/sensores")[0].payload)


def test_a_strangers_halt_stops_a_moving_arm(world):
    world.request_task("sis_a 0B 7")
    body = world.boards["ra_1"].body
    assert world.advance(30.0, until=lambda: body.moving)
    begin(world, fault("foreign_halt", "ra_1"))
    assert body.motors.targets != (0, 0, 0)
    assert world.advance(0.6, until=lambda: not body.moving)


@pytest.mark.parametrize("axes", [None, 3, 6])
@pytest.mark.parametrize("channel", Channel)
def test_garbage_makes_sense_on_no_channel(channel, axes):
    for raw in GARBAGE:
        with pytest.raises(PayloadError):
            decode(channel, raw, axes=axes)


def asked(world: World, fault: Fault) -> list[Any]:
    """Requests that reach the plant by a fault."""
    events: list[Any] = []

    def look() -> None:
        events.extend(world.moment.requests)

    world.watchers.append(look)
    begin(world, fault)
    world.watchers.remove(look)
    return events


@pytest.mark.parametrize("verb", SAID)
def test_an_operator_says_what_he_says(world, verb):
    for target in ("", "sis_a", "ra1", "nowhere"):
        (event,) = asked(world, fault(f"operator_{verb.value}", target))
        assert (event.verb, event.scope, event.by_hand) == (verb, target, False)


def test_an_operator_declares_only_what_cannot_tell_itself():
    homing = KINDS["operator_home"].words
    assert homing(shipped(), "ra1") == ("",)
    assert homing(shipped(evidence=Evidence.JOINTS), "ra1") == ("", "by hand")
    world = World(shipped("sis_a", evidence=Evidence.JOINTS))
    assert asked(world, fault("operator_home", "ra1", word="by hand")) == []
    told: list[Any] = []
    world.watchers.append(lambda: told.extend(world.moment.requests))
    world.advance(2.0)
    assert [event.by_hand for event in told] == [True], "once it stands at its reference"


@pytest.mark.parametrize(
    ("word", "scope"),
    [("its running task", "t-1000-2"), ("a queued task", "t-1000-3"), ("an ended task", "t-1000-1")],
)
def test_an_operator_cancels_a_task_that_is_there(world, word, scope):
    for _ in range(3):
        world.request_task("sis_a 0B 7")
    world.advance(0.5)
    world.request_verb(Verb.STOP)
    world.advance(1.0)
    for verb in (Verb.CLEAR, Verb.RESET, Verb.RESUME):
        world.request_verb(verb)
        world.advance(0.3)
    (event,) = asked(world, fault("operator_cancel", "sis_a", word=word))
    assert event.scope == scope


def test_an_operator_cancels_a_task_that_never_was(world):
    (event,) = asked(world, fault("operator_cancel", "sis_a", word="a queued task"))
    assert event.scope == "t-0-0"


@pytest.mark.parametrize(("word", "new"), [("text", 2), ("id", 1), ("other text", 1), ("known id", 1)])
def test_a_task_that_is_asked_for_twice_is_the_same_only_by_its_id(world, word, new):
    before = len(world.plant.intake.tasks)
    events = asked(world, fault("double_submit", "sis_a", word=word))
    assert len(events) == 2
    assert len(world.plant.intake.tasks) == before + new


def test_a_known_id_is_asked_for_again(world):
    world.request_task("sis_a palletizing #lot7")
    world.settle()
    (event,) = asked(world, fault("double_submit", "sis_a", word="known id"))
    assert event.text == "sis_a palletizing #lot7"


@pytest.mark.parametrize("word", KINDS["bad_task"].words(shipped("sis_a"), "sis_a"))
def test_a_bad_text_is_no_task(world, word):
    before = len(world.plant.intake.tasks)
    assert asked(world, fault("bad_task", "sis_a", word=word))
    assert len(world.plant.intake.tasks) == before
