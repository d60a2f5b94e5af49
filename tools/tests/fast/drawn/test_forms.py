"""Recipes of drawn plants do the same in Python and as trees in XML."""

from __future__ import annotations

import pytest

from arboleda_drawn import devices
from arboleda_drawn.devices import DrawnDevices, Form, can_be_xml, drawn, steps
from arboleda_drawn.forms import differences

LAMP = {
    "name": "drawn_0",
    "kinds": {"lamp": {"verbs": {"blink": {"effect": "process", "takes_s": 1}}}},
    "cells": {"cell": {"devices": {"lamp": {"kind": "lamp"}}}},
}


def blinking(times: int) -> DrawnDevices:
    step = steps.Repeat(step=steps.Tell(role="lamp", verb="blink"), times=times)
    return DrawnDevices(
        section=LAMP, recipes=(steps.Recipe(name="do_1", parameters=(), step=step),), form=Form.XML
    )


@pytest.mark.long
@pytest.mark.parametrize("seed", [1, 11, 15])
def test_both_forms_do_the_same(seed: int) -> None:
    plant = devices.draw(seed)
    assert all(map(can_be_xml, plant.recipes)), "there is something to compare"
    assert differences(plant, seed) == []


def test_what_differs_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    assert differences(blinking(2), 1) == []
    write = drawn.xml_of
    monkeypatch.setattr(
        drawn, "xml_of", lambda *each: write(*each).replace('num_cycles="2"', 'num_cycles="1"')
    )
    (found,) = differences(blinking(2), 1)
    assert found.startswith("lamp 2: Python ProcessCall") or found.startswith("lamp 3: Python ProcessCall")
    assert found.endswith("XML nothing")
