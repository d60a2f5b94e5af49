"""What is told of the mapping of an example's belt, with one change in its plant file."""

from __future__ import annotations

from dataclasses import dataclass

from tests.packages import ROOT

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Robot
from arboleda.plant_file import settings
from arboleda.plant_file.document import Document

EXAMPLE = ROOT / "examples/plc_conveyor"


@dataclass(frozen=True, kw_only=True)
class Example:
    """A plant file of the example, whose belt has this driver with settings of this class."""

    file: str
    driver: str
    settings: type

    @property
    def text(self) -> str:
        return (EXAMPLE / self.file).read_text("utf-8")

    def problems(self, belt: Robot, old: str, new: str) -> tuple[str, ...]:
        """What is told with this change."""
        text = self.text
        assert text.count(old) == 1, old
        document = Document("plant.yaml", text.replace(old, new).encode())
        place = ("cells", "line", "devices", "belt", "driver", self.driver)
        try:
            read = settings.read(document, place, settings.shape(self.driver, self.settings), self.settings)
            for inside, sentence in read.problems(belt) if read is not None else ():
                document.problem((*place, *inside), sentence)
        except settings.SettingsRefused as unfit:
            document.problem(unfit.place, str(unfit))
        try:
            document.finish()
        except ConfigError as error:
            return error.problems
        return ()
