"""What must hold of the plant: run them with pytest, no hardware is needed."""


def test_a_blank_is_pressed(sim):
    sim.plant("plant.yaml")
    task = sim.submit("cell press feed 3")
    sim.run(until=lambda: task.ended)
    assert task.state == "done"


def test_a_press_that_reboots_at_work_fails_the_task(sim):
    sim.plant("plant.yaml")
    task = sim.submit("cell press spare 5")
    sim.run(until=lambda: sim.robot("press").moving)
    sim.fault("reboot", "press")
    sim.run(until=lambda: task.ended)
    assert task.state == "failed"
