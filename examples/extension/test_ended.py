"""Test of this package; pytest has `plant_with` where Arboleda is installed."""

from arboleda_ended.part import EndedTasks


def test_a_task_that_ended_is_counted(plant_with):
    plant = plant_with(EndedTasks)
    assert plant.submit("sis_a 0B 7") == "queued"
    assert plant.wait(900, until=lambda: plant.shown(EndedTasks)["counts"]["sis_a"] == 1)
    plant.restart()
    assert plant.get("/api/ended")["sis_a"] == 1
