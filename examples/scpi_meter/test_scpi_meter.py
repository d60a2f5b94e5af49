"""The driver goes through the contract of all drivers: `python -m pytest`, in this folder."""

import pytest
from played_meter import PlayedMeter

from arboleda.testing.drivers import Bench, DriverContract, open_shop

PLANT = """
name: lab
uses: [recipes.py, scpi_meter]
kinds:
  meter:
    verbs:
      resistance: {effect: query, answers: [good, bad], at_most_s: 60}
      voltage: {effect: query, answers: [good, bad], at_most_s: 60}
      continuity: {effect: query, answers: [good, bad], at_most_s: 60}
cells:
  shop: {devices: {meter: {kind: meter, driver: {scpi_meter: {host: 127.0.0.1, port: %d}}}}}
"""
TOLD = {"device": "meter", "work": "resistance()", "other": "voltage()", "ask": "continuity()"}
CAN = {"asks": True, "drops_questions": False, "halts_work": False, "proves": False, "stops": ["halt"]}


def opened(folder, state):
    meter = PlayedMeter()
    return open_shop(folder, state, PLANT % meter.port, **TOLD), lambda app: meter


class TestScpiMeter(DriverContract):
    @pytest.fixture
    def bench(self):
        return Bench(open=opened, **CAN, takes="scpi_meter.ScpiMeter.heard")
