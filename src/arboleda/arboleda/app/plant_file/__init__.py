"""How a plant file is read, from strict YAML to what its parts mean together; `app.config` is the way in."""
