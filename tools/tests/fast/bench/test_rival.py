"""Reactions that `rival` counts, by the lines of a process."""

from __future__ import annotations

from arboleda_bench import rival


class Lines:
    """A process that says these lines."""

    def __init__(self, *lines: str) -> None:
        self._lines = iter(lines)
        self.written: list[str] = []

    def read(self) -> str:
        return next(self._lines)

    def write(self, line: str) -> None:
        self.written.append(line)


def test_each_step_is_ended_and_what_follows_a_drive_or_a_move_counts():
    process = Lines("do drive", "do move", "do switch", "do move", "end")
    found = rival.cycle(process, lambda: 0.0)  # type: ignore[arg-type]
    assert process.written == ["task", *["done"] * 4]
    assert len(found) == 2  # drive to move, move to switch


def test_the_first_command_and_the_end_of_a_task_are_no_reactions():
    assert rival.cycle(Lines("do drive", "end"), lambda: 0.0) == []  # type: ignore[arg-type]
