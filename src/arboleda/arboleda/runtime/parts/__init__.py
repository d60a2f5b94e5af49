"""The parts a plant is put together from; each starts, stops, and owns its loop and clients."""
