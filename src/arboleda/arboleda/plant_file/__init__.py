"""Reader of a plant file, from strict YAML to the meaning of the whole; `loader.py` is the way in."""
