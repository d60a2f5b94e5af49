"""Tests of the pair: run them with pytest, no board is needed."""

import pytest


@pytest.mark.parametrize("text", ["sis_a 0B 7", "sis_b fetch 1C 4", "ra1 palletizing"])
def test_a_task_is_done(sim, text):
    sim.plant("plant.yaml")
    task = sim.submit(text)
    sim.run(until=lambda: task.ended)
    assert task.state == "done"


def test_a_mobile_robot_that_is_jammed_once_tries_again(sim):
    sim.plant("plant.yaml")
    task = sim.submit("sis_a fetch 0B 7")
    sim.run(until=lambda: sim.cell("sis_a").step == "drive path 0B")
    sim.fault("driver_alarm", "rm_sis_a", seconds=1)
    sim.run(until=lambda: task.ended)
    assert task.state == "done"


def test_a_board_that_boots_with_a_part_in_hand_fails_the_task(sim):
    sim.plant("plant.yaml")
    task = sim.submit("sis_b fetch 0B 7")
    sim.run(until=lambda: sim.cell("sis_b").step == "move to station 7")
    sim.fault("reboot", "ra2")
    sim.run(until=lambda: task.ended)
    assert (task.state, task.reason) == ("failed", "rebooted")
    sim.rest()
