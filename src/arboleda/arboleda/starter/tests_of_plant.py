"""Tests of the plant: run them with pytest, no hardware is needed."""


def test_a_blank_is_pressed(sim):
    sim.plant("plant.yaml")
    task = sim.submit("cell press feed 3")
    sim.run(until=lambda: task.ended)
    assert task.state == "done"
    assert sim.robot("press").facts == {"door": "open", "pressed": True}


def test_a_press_that_loses_power_behind_its_door_fails_the_task(sim):
    sim.plant("plant.yaml")
    task = sim.submit("cell press spare 5")
    sim.run(until=lambda: sim.robot("press").facts["door"] == "closed")
    sim.fault("reboot", "press")
    sim.run(until=lambda: task.ended)
    assert task.state == "failed"


def test_nothing_breaks_whatever_goes_wrong(sim):
    sim.plant("plant.yaml")
    sim.seeds(3)
