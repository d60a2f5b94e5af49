"""Robot models as URDF: `urdf/*.urdf.xacro`, processed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import lru_cache
from importlib.resources import as_file, files
from pathlib import Path
from typing import NamedTuple
from xml.parsers.expat import ExpatError

ENDING = ".urdf.xacro"


class Limits(NamedTuple):
    """The limits of a joint: position in rad or m, speed in rad/s or m/s."""

    lower: float
    upper: float
    velocity: float


def models() -> tuple[str, ...]:
    """The models that can be rendered."""
    names = (entry.name for entry in files("arboleda_description").joinpath("urdf").iterdir())
    return tuple(sorted(name.removesuffix(ENDING) for name in names if name.endswith(ENDING)))


def render(model: str, *, prefix: str, limits: Mapping[str, Limits] | None = None) -> str:
    """The URDF of a model; `limits` by joint name without prefix replace the model's own.

    ModuleNotFoundError without the xacro library; ValueError where the model has no usable urdf/*.xacro.
    """
    import xacro  # only who draws needs it

    if model not in models():
        raise ValueError(f"there is no urdf/{model}{ENDING}; there are {', '.join(models())}")
    with as_file(files("arboleda_description")) as folder:
        try:
            return _processed(folder / "urdf" / (model + ENDING), prefix, json.dumps(limits or {}))
        except (xacro.XacroException, ExpatError) as error:
            why = " ".join(str(error).split())
            raise ValueError(f"urdf/{model}{ENDING} cannot be processed: {why}") from error


@lru_cache(maxsize=128)  # xacro takes a twentieth of a second, for the same robot each time a plant is drawn
def _processed(file: Path, prefix: str, limits: str) -> str:
    import xacro

    document = xacro.process_file(str(file), mappings={"prefix": prefix, "limits": limits})
    text: str = document.documentElement.toprettyxml(indent="  ")
    return '<?xml version="1.0"?>\n' + text
