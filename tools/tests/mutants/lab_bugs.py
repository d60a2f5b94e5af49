"""Every bug of the laboratory, and those that neither `check` nor `simulate` finds, each with its reason."""

from __future__ import annotations

from .lab_plant_bugs import PLANT_BUGS
from .lab_recipe_bugs import RECIPE_BUGS
from .lab_step_bugs import STEP_BUGS

LAB_BUGS = (*RECIPE_BUGS, *STEP_BUGS, *PLANT_BUGS)
NOT_FOUND = {
    "The nest is no place.": "a target that is no place gives and takes any number, and the recipe is right",
    "The clamp holds no part.": "the recipe opens the clamp in time, though nothing would tell if it did not",
}
