"""NAME: counts the tasks that end in each cell, and tells it over HTTP."""

from dataclasses import dataclass

from arboleda.extension import Part


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings in the plant file: `extensions: {NAME: {counts: failed}}`."""

    counts: str = "done"  # the state of the tasks that are counted


class Counter(Part, settings=Settings):
    def start(self):
        """Go on with what earlier starts have counted."""
        self.kept = self.plant.table()
        self.plant.show(**self.kept.rows())
        self.plant.on_task(self.count)

    def count(self, task):
        """Count a task that ended; called in a thread of this part with every change of a task."""
        if task.state == self.settings.counts:
            self.kept.put({task.cell: self.kept.get(task.cell, 0) + 1})
            self.plant.show(**self.kept.rows())

    def routes(self):
        api = super().routes()

        @api.get("/api/NAME")
        def counted() -> dict[str, int]:
            """The number of tasks that ended so, by cell."""
            return self.kept.rows()

        return api
