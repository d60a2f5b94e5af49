"""The parts of the record: robots, commands, tasks, cells and boards, by what was said and done."""
