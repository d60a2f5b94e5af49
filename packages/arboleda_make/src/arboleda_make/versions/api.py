"""The versions of a plant's files as the web server sees them: which is at work, and putting one to work."""

from __future__ import annotations

from abc import abstractmethod
from typing import Protocol

from ..drafts.api import State


class VersionsApi(Protocol):
    """Versions of one plant, as plain data with the keys of types in `arboleda_make.answers`.

    DraftRefused, and nothing is changed, where it cannot be.
    """

    @abstractmethod
    def listed(self) -> State:
        """The versions, and what each cell works by: VersionList."""

    @abstractmethod
    def put(self, number: int, by: str) -> State:
        """Put a kept version to work, and bring its files back where they are others now: AppliedDraft. It
        waits for seconds."""

    @abstractmethod
    def restart(self, by: str, *, wanted: bool) -> State:
        """Have the plant restart with the files that are in their place, once all its cells rest: until then
        no further task begins. Not `wanted`: no more. It answers as `listed` does.
        """
