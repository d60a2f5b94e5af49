"""Simulated plants have records too, which tell the same as they did."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from tests.unit.recorder.recorded import FILES

from arboleda.model.messages import Jog, Verb
from arboleda.model.recording import Limits
from arboleda.recorder import reader
from arboleda.recorder.files import parts_in
from arboleda.rig.world import PLANT, World
from arboleda.testing.plants import shipped
from arboleda_proofs.campaigns.simulated_recorder import SECOND, SimulatedRecorder
from arboleda_proofs.playback.replay import plant_of, replayed
from arboleda_proofs.playback.views import Views

BEGAN_NS = 1_790_000_000 * SECOND


def test_each_start_of_a_simulated_plant_has_a_record_that_is_the_same_again(tmp_path: Path) -> None:
    recorder = SimulatedRecorder(tmp_path, FILES, Limits(), BEGAN_NS)
    world = World(shipped(), make_plant=recorder.plant)
    world.request_task("sis_a 0B 7 #lot")
    world.advance(20.0)
    world.crash(PLANT)
    world.advance(20.0)
    recorder.close()
    first, second = (reader.opened(part.path) for part in parts_in(tmp_path))
    for record in (first, second):
        *_, last = replayed(plant_of(record.first.beginning, shipped()), record.steps())
        assert last.difference is None and last.number > 20
    assert [each.id for each in second.first.beginning.kept] == ["lot"]
    views = Views(second)
    assert views.began_ns >= BEGAN_NS + round(world.now - 25.0) * SECOND
    states = {each["name"]: each["state"] for each in views.at(views.ended_ns)["cells"]}
    assert states == {name: cell.state.value for name, cell in world.plant.cells.items()}


def test_a_cell_that_was_taught_is_the_same_again(tmp_path: Path) -> None:
    recorder = SimulatedRecorder(tmp_path, FILES, Limits(), BEGAN_NS)
    world = World(shipped(), make_plant=recorder.plant)
    world.advance(2.0)
    world.request_verb(Verb.TEACH, "sis_a", arguments=(("teacher", "ana"),))
    world.advance(0.1)
    teaching = world.plant.cells["sis_a"].manual.teaching
    assert teaching is not None
    button = Jog(at=0.0, cell="sis_a", session=teaching.session, number=1, robot="ra1", goal=(0.3, 0.0, 0.02))
    for _ in range(20):
        world.tell(replace(button, at=world.now))
        world.advance(0.05)
    world.advance(2.0)
    recorder.close()
    (record,) = (reader.opened(part.path) for part in parts_in(tmp_path))
    steps = list(record.steps())
    *_, last = replayed(plant_of(record.first.beginning, shipped()), steps)
    assert last.difference is None and last.number > 20
    assert sum(isinstance(event, Jog) for step in steps for event in step.events) == 20
    moves = [
        message for step in steps for message in step.result["messages"] if message["type"] == "MoveJoints"
    ]
    assert len(moves) > 5
