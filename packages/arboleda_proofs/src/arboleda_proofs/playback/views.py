"""Views of the plant as screens had them, at any moment of a record."""

from __future__ import annotations

import json
from bisect import bisect_right
from collections import OrderedDict
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import zstandard

from arboleda.recorder import channels, files, plain_data, reader
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.reader import Record
from arboleda.recorder.rows import links_of, positions_of, snapshot_of

from .chunks import ChunkFile, messages

WINDOWS = 8  # half minutes of a record that are kept in memory
KEPT = {channels.VIEW, channels.CHANGES, channels.EVENTS}
NONE = -1  # the number of a channel that is not known
EXACT_NS = 1000  # a time as a float of Unix seconds, as events have it, is not more exact
Row = dict[str, Any]
Rows = dict[str, Row]


@dataclass(frozen=True)
class ViewChange:
    """View message: a whole view, or the changes since the one before."""

    unix_ns: int
    at: float
    gone: Sequence[str]
    rows: Rows


@dataclass(kw_only=True)
class Window:
    """Views from one whole view to the next; `ended` if that next one is written already."""

    changes: list[ViewChange]
    ended: bool
    chunks: int  # of its file, when it was read

    @cached_property
    def times(self) -> list[int]:
        return [each.unix_ns for each in self.changes]

    def between(self, after_ns: int, until_ns: int) -> list[ViewChange]:
        """The views after one moment and up to another."""
        return self.changes[bisect_right(self.times, after_ns) : bisect_right(self.times, until_ns)]


class Views:
    """Snapshots of a record, by their time; NoRecord for one that has none. For one thread.

    Also of a record that is being written: what came to it is found.
    """

    def __init__(self, record: Record) -> None:
        self._files = [ChunkFile(path) for path in record.paths]
        self._channels: dict[str, int] = {}
        self._windows: OrderedDict[tuple[Path, int, int], Window] = OrderedDict()
        self._times: dict[Path, list[int]] = {}
        self._know_channels()

    @property
    def began_ns(self) -> int:
        """The time of the first view, Unix ns; raises NoRecord if there is none."""
        with _legible(self._files):
            return self._first().times[0]

    @property
    def ended_ns(self) -> int:
        """The time of the last step, Unix ns."""
        with _legible(self._files):
            ends = [file.index().chunks[-1].end_ns for file in self._followed() if file.index().chunks]
        return ends[-1] if ends else self.began_ns

    def at(self, unix_ns: int) -> Row:
        """The snapshot at a moment, with its spans as of then; before the first one, the first."""
        with _legible(self._files):
            return snapshot_of(*self._moment(unix_ns))

    def positions(self, unix_ns: int) -> Row:
        """The row from which the twin is drawn at a moment."""
        with _legible(self._files):
            return positions_of(*self._moment(unix_ns))

    def links(self, unix_ns: int) -> Row:
        """The row of the plant's links at a moment: broker, ROS 2 and refused messages."""
        with _legible(self._files):
            return links_of(self._moment(unix_ns)[0])

    def times(self) -> Sequence[int]:
        """The times of all views, in order."""
        with _legible(self._files):
            return [at for file in self._followed() for at in self._times_of(file)]

    def events(self) -> list[Row]:
        """The whole time line, as `views.chronicle` makes it, the oldest event first."""
        with _legible(self._files):
            found = {row["number"]: row for file in self._followed() for row in self._events_of(file)}
            return [found[number] for number in sorted(found)]

    def rows(self, unix_ns: int) -> Rows:
        """The rows of the view at a moment, exact to the ns."""
        with _legible(self._files):
            return self._moment(unix_ns - EXACT_NS)[0]

    def changes(self, after_ns: int, until_ns: int) -> Iterator[ViewChange]:
        """All views after a moment and up to another, in order."""
        with _legible(self._files):
            for window in self._windows_from(after_ns, until_ns):
                yield from window.between(after_ns, until_ns)

    def _windows_from(self, after_ns: int, until_ns: int) -> Iterator[Window]:
        first = self._window(after_ns) or self._first()
        yield first
        began_ns = first.times[0]
        for file in self._followed():
            chunks = file.index().chunks
            for number in range(max(0, file.index().position(began_ns)), len(chunks)):
                places = chunks[number].indexes.get(self._channels[channels.VIEW])
                for at_ns, place in file.times(places) if places else ():
                    if at_ns > until_ns:
                        return
                    if at_ns > began_ns:
                        yield self._read(file, number, place)

    def _followed(self) -> list[ChunkFile]:
        """The files that are still there, with the one that came after the last, if that was closed."""
        while len(self._files) > 1 and not self._files[0].path.exists():
            del self._files[0]
        self._know_channels()
        while self._files[-1].index().whole:
            part = files.part_at(self._files[-1].path)
            if part is None:
                break
            following = files.part_path(part.path.parent, part.epoch, part.number + 1)
            if not following.exists():
                break
            self._files.append(ChunkFile(following))
        return self._files

    def _know_channels(self) -> None:
        """Read the channels from the first chunk, which a plant that just began has not written yet."""
        if not self._channels:
            path = self._files[0].path
            self._channels = reader.channels_of(path)
            if self._channels and not self._channels.keys() >= KEPT:
                raise NoRecord(f"{path} was written by an Arboleda that kept no views: replay it.")

    def _moment(self, unix_ns: int) -> tuple[Rows, float]:
        """The rows at a moment, and the time of it on the plant's clock."""
        window = self._window(unix_ns + EXACT_NS) or self._first()
        count = max(1, bisect_right(window.times, unix_ns + EXACT_NS))
        rows: Rows = {}
        for change in window.changes[:count]:
            for key in change.gone:
                rows.pop(key, None)
            for key, fields in change.rows.items():
                rows[key] = {**rows.get(key, {}), **fields}
        last = window.changes[count - 1]
        since_ns = min(unix_ns, self.ended_ns) - last.unix_ns
        return rows, last.at + max(0, since_ns) / 1e9

    def _window(self, unix_ns: int) -> Window | None:
        """The views from the last whole one before a moment on; None if there is none."""
        for file in reversed(self._followed()):
            for number in range(file.index().position(unix_ns), -1, -1):
                index = file.index().chunks[number].indexes.get(self._channels.get(channels.VIEW, NONE))
                places = [place for at, place in file.times(index) if at <= unix_ns] if index else []
                if places and (window := self._read(file, number, places[-1])).changes:
                    return window
        return None

    def _first(self) -> Window:
        for file in self._followed():
            for number, chunk in enumerate(file.index().chunks):
                index = chunk.indexes.get(self._channels.get(channels.VIEW, NONE))
                places = file.times(index) if index else []
                if places and (window := self._read(file, number, places[0][1])).changes:
                    return window
        raise NoRecord(f"{self._files[0].path} ends before anything could be seen.")

    def _read(self, file: ChunkFile, number: int, place: int) -> Window:
        key, chunks = (file.path, number, place), len(file.index().chunks)
        known = self._windows.get(key)
        if known is None or not (known.ended or known.chunks == chunks):
            changes = [*self._changes(file, number, place)]
            ended = None in changes
            known = Window(changes=[each for each in changes if each is not None], ended=ended, chunks=chunks)
            self._windows[key] = known
        self._windows.move_to_end(key)
        while len(self._windows) > WINDOWS:
            self._windows.popitem(last=False)
        return known

    def _changes(self, file: ChunkFile, number: int, place: int) -> Iterator[ViewChange | None]:
        """The views from a place on; a None in the end if the next whole view follows."""
        view, changes = (self._channels.get(topic, NONE) for topic in (channels.VIEW, channels.CHANGES))
        first = True
        for chunk in file.index().chunks[number:]:
            begins = place if first else 0
            for channel, unix_ns, data in messages(file.content(chunk), (view, changes), begins):
                if channel == view and not first:
                    yield None
                    return
                first = False
                yield _change(unix_ns, data)

    def _times_of(self, file: ChunkFile) -> list[int]:
        index, changes = file.index(), self._channels.get(channels.CHANGES, NONE)
        if file.path not in self._times:
            places = [chunk.indexes[changes] for chunk in index.chunks if changes in chunk.indexes]
            found = [at for place in places for at, _ in file.times(place)]
            if not index.whole:
                return found
            self._times[file.path] = found
        return self._times[file.path]

    def _events_of(self, file: ChunkFile) -> Iterator[Row]:
        """The events in the digests of a file, and those not in a digest yet."""
        index, channel, digested = file.index(), self._channels.get(channels.EVENTS, NONE), 0
        for name, offset in index.attachments:
            if name.startswith(files.DIGEST):
                digested = offset
                yield from _digest(file.attachment(offset))
        for chunk in index.chunks:
            if chunk.offset > digested and channel in chunk.indexes:
                for _, _, data in messages(file.content(chunk), (channel,)):
                    yield plain_data.value_from(json.loads(data))


@contextmanager
def _legible(read: list[ChunkFile]) -> Iterator[None]:
    """Context that turns any error from a damaged file into a sentence."""
    try:
        yield
    except OSError as error:
        raise NoRecord(f"{error.filename} cannot be read: {error.strerror}.") from error
    except (AttributeError, IndexError, KeyError, TypeError, ValueError, *files.TORN) as error:
        raise NoRecord(f"{read[0].path}, or a file after it, is damaged.") from error


def _digest(content: bytes) -> list[Row]:
    if zstandard.frame_content_size(content) > reader.LARGEST:
        return []
    rows: list[Row] = plain_data.value_from(json.loads(zstandard.decompress(content)))
    return rows


def _change(unix_ns: int, data: bytes) -> ViewChange:
    rows: dict[str, Any] = json.loads(data)
    return ViewChange(unix_ns, float(rows["at"]), rows.get("gone", ()), rows["rows"])
