"""Running plants: the parts that a plant is built of, its loop, its state directory, its leader."""
