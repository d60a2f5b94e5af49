"""How a plant file is read, from strict YAML to what its parts mean together; `loader.py` is the way in."""
