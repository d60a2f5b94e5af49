"""The pure core: no I/O, no clock, no thread; every change happens in `Plant.step`."""
