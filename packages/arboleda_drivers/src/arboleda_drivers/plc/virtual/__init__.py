"""PLC with a belt, a gate and an eye: its program, which every protocol of PLCs shows in its own way."""
