"""Tests of this package: run them with pytest, no hardware is needed."""

from NAME import Counter, Settings


def test_the_tasks_that_are_done_are_counted(plant_with):
    plant = plant_with(Counter, settings=[Settings()])
    plant.submit("sis_a 0B 7")
    assert plant.wait(900, until=lambda: plant.shown(Counter) == {"sis_a": 1})
    plant.restart()
    assert plant.get("/api/NAME") == {"sis_a": 1}
