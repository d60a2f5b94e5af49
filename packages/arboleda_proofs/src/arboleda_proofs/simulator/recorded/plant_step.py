"""Kind of the step that the plant made in this pass over a world.

`screens_are_told_of_news` finds by it an operator's act that is shown only with the next news.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class PlantStep:
    """The plant's step of this pass, made `at` this time, or else its last one.

    `stepped`: it was made in this pass; `born`: the plant started in it; `begins`: it is the plant's first;
    `away`: the plant finds in it that it did nothing for long. `news`: something changed in it besides what
    robots report, or it is time to look at everything again; `has_spoken`: the plant spoke of a task,
    answered somebody, or a cell changed its state. `unnumbered`: a cell or a task changed in it, but not the
    number by which screens know of changes.
    """

    at: float
    stepped: bool = False
    born: bool = False
    begins: bool = False
    away: bool = False
    news: bool = False
    has_spoken: bool = False
    unnumbered: bool = False

    def pass_by(self) -> None:
        """Take in a pass in which the plant did nothing."""
        self.stepped = self.news = self.born = self.begins = False
