"""The draft of a plant's files as the web server sees it: who edits it, its steps, its check, and its end."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, Protocol

from arboleda.extension import Refused

State = dict[str, Any]
Place = Sequence[str | int]


class DraftRefused(Refused):
    """The draft is not changed; the sentence says why, such as who edits it."""


class DraftApi(Protocol):
    """Draft of one plant; all data is plain, with the keys of types in `arboleda_make.answers`.

    `editor` is an id that its page or tool has made for itself. Each step answers the DraftState that it
    leads to; DraftRefused, and nothing is changed, where it cannot be.
    """

    @abstractmethod
    def state(self) -> State:
        """The draft: DraftState."""

    @abstractmethod
    def take(self, editor: str, name: str) -> State:
        """Begin to edit, or take over from whoever edits; `name` is shown to others."""

    @abstractmethod
    def set(self, editor: str, place: Place, value: Any, of: str | None = None) -> State:
        """Set a plain value of the plant file; `of` is the digest of the only draft in which to set it."""

    @abstractmethod
    def remove(self, editor: str, place: Place) -> State:
        """Remove a key of the plant file."""

    @abstractmethod
    def undo(self, editor: str) -> State:
        """Take the last step back."""

    @abstractmethod
    def redo(self, editor: str) -> State:
        """Do the step again that was taken back last."""

    @abstractmethod
    def discard(self, editor: str) -> State:
        """Forget all of the draft."""

    @abstractmethod
    def check(self) -> State:
        """Findings of `arboleda check` in the draft: CheckedDraft. It waits for seconds."""

    @abstractmethod
    def keep(self, editor: str, note: str) -> State:
        """Check the draft, write it into the files and keep a version: KeptDraft. It waits for seconds."""

    @abstractmethod
    def apply(self, editor: str, note: str) -> State:
        """The same, and put the version to work: AppliedDraft."""

    @abstractmethod
    def trees(self, file: str) -> State:
        """A file of trees as the draft has it: TreesText."""

    @abstractmethod
    def set_trees(self, editor: str, file: str, text: str) -> State:
        """Give a file of trees another text, or add one."""

    @abstractmethod
    def remove_trees(self, editor: str, file: str) -> State:
        """Take a file of trees out of the draft."""

    @abstractmethod
    def own(self, editor: str) -> State:
        """Copy files that nobody can change, as those that come with Arboleda, to a folder of one's own, and
        go on there."""
