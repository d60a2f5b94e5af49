"""Simulated plants have records too, which tell the same as they did."""

from __future__ import annotations

from pathlib import Path

from arboleda.recorder import reader
from arboleda.recorder.files import parts_in
from arboleda.recorder.preamble import Limits
from arboleda.recorder.replay import plant_of, replayed
from arboleda.recorder.simulated import SimulatedRecorder
from arboleda.recorder.tape import SECOND
from arboleda.recorder.views import Views
from arboleda.simulator.world import PLANT, World
from arboleda.testing.plants import shipped

from .recorded import FILES

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
