"""Time by part of the house."""

from __future__ import annotations

import re

from arboleda.rig.rig import Rig
from arboleda.testing import plants
from arboleda_bench.time_by_part import time_by_part


def test_the_shares_of_the_parts_add_up_and_libraries_belong_to_their_callers():
    plant = plants.shipped("sis_a")  # reading the file belongs to no part
    lines = time_by_part(lambda: Rig(plant).wait(1.0))
    shares = {line[:20].strip(): float(re.findall(r"([\d.]+) %", line)[0]) for line in lines}
    assert 99.0 < sum(shares.values()) < 101.0
    assert shares["boards"] > 0
    assert shares["plant"] > 0
    assert shares.get("other", 0.0) < 50.0
