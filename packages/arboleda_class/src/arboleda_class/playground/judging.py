"""Judging of an exercise in the tab: the verdict of `arboleda exercise check`, and a film of a finding."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda.model.plant_model import PlantModel
from arboleda_class.exercises.exercise import PLANT, exercise
from arboleda_class.exercises.judge import Again, Judge
from arboleda_class.exercises.trial_run import run_trial
from arboleda_proofs.campaigns.plants import Plant

from .building import Texts, built
from .film import Film


def judged(
    name: str, texts: Texts, progress: Callable[[float], object]
) -> tuple[dict[str, Any], Film, PlantModel | None]:
    """The verdict on a work as plain data; a film of its first finding, and the plant of that, or None."""
    chosen, film, filmed = exercise(name), Film(), list[PlantModel]()

    def play(plant: Plant, again: Again) -> None:
        again(film.plant)
        filmed.append(plant.model)

    files = {each: text.encode() for each, text in texts.items()}
    judge = Judge(chosen, files, progress=lambda runs: progress(min(runs / chosen.runs, 1.0)))
    verdict = judge.judge(play=play).plain
    return verdict, film, filmed[0] if filmed else None


def record(name: str) -> tuple[Film, PlantModel | None]:
    """A film of the record that belongs to an exercise, and the plant of that; None if it has none."""
    chosen, film = exercise(name), Film()
    if chosen.record is None:
        return film, None
    texts = {each: content.decode("utf-8") for each, content in chosen.start.items()}
    model, _ = built(texts, PLANT)
    run_trial(model, chosen.record, chosen.record.faults, make_plant=film.plant)
    return film, model
