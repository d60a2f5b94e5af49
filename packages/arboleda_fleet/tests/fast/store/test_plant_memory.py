"""Figures of the OEE are made of the memory of a plant."""

from __future__ import annotations

from tests.unit.store.memory_samples import ended, queued
from tests.unit.store.test_plant_memory import site as site
from tests.unit.store.test_plant_memory import store as store

from arboleda.model.messages import (
    TaskState,
)
from arboleda_fleet.oee.api import OeeQuery
from arboleda_fleet.oee.rows import figures


def test_figures_are_made_of_what_was_kept(site):
    with site.memory() as store:
        store.times.began(900.0)
        store.tasks.keep(queued("a"), "storage", 910.0)
        store.tasks.keep(ended("a", TaskState.RUNNING), "storage", 920.0)
        store.tasks.keep(ended("a"), "storage", 930.0)
        store.times.stands("sis_a", "held", 940.0)
        store.times.stands("sis_a", None, 950.0)
        store.times.note_run(1000.0, ended=True)
        (found,) = figures(site.history(), OeeQuery(since_s=900.0, until_s=1000.0), 1000.0)
    assert (found.cell, found.done, found.failed) == ("sis_a", 1, 0)
