"""Part of a plant that a package brings."""

from __future__ import annotations

from dataclasses import is_dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from arboleda.model.errors import ArboledaError

if TYPE_CHECKING:
    from fastapi import APIRouter  # a plant without a page needs none

    from .plant import Plant

NO_SETTINGS = "the settings of {name} must be a frozen dataclass"


class Part:
    """Part of a plant that a package brings; one is made where the plant starts.

    A package registers its class under the entry point group `arboleda.parts`. `start`, `stop` and `routes`
    are there to be overridden, and nothing else. `self.plant` is the plant. `self.settings` is what the plant
    file says under `extensions`, as the dataclass that the class names:
    `class Orders(Part, settings=OrderSettings)`.
    """

    settings_type: ClassVar[type | None] = None

    def __init_subclass__(cls, *, settings: type | None = None, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if settings is None:
            return
        if not (is_dataclass(settings) and settings.__dataclass_params__.frozen):  # type: ignore[attr-defined]
            raise ArboledaError(NO_SETTINGS.format(name=cls.__name__))
        cls.settings_type = settings

    def __init__(self, plant: Plant, settings: Any = None) -> None:
        self.plant = plant
        self.settings = settings

    def start(self) -> None:
        """Begin; the plant has not begun yet, and waits for this.

        Tasks that are given here are answered once it has begun: do not wait for their answers here.

        A StartError says that the plant must not start. Anything else that is raised leaves out this part.
        """

    def stop(self) -> None:
        """End; the plant has ended. After 3 s nobody waits any more."""

    def routes(self) -> APIRouter:
        """The routes that this part adds to the HTTP API; called once, after `__init__`."""
        from fastapi import APIRouter

        return APIRouter()
