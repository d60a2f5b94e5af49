"""Work on records: forks, cases for the simulator, reports of tasks, the page of a record."""
