"""The part that counts ended tasks in a table, and tells the counts."""

from arboleda.extension import Part


class EndedTasks(Part):
    def start(self):
        self.table = self.plant.table()
        self.plant.on_task(self.count)
        self.show()

    def count(self, task):
        if task.has_ended:
            self.table.put({task.cell: self.table.get(task.cell, 0) + 1})
            self.show()

    def show(self):
        self.plant.show(counts=dict.fromkeys(self.plant.cells, 0) | self.table.rows())

    def routes(self):
        api = super().routes()

        @api.get("/api/ended")
        def ended() -> dict[str, int]:
            """How many tasks ended in each cell, in all starts."""
            return self.plant.shown["counts"]

        return api
