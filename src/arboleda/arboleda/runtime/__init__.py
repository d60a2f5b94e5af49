"""Running plants: the parts that a plant is built of, its loop, its state directory, its leader."""

import logging

# Nothing is written to the standard error of a program that puts a plant together and sets up no logging.
logging.getLogger("arboleda").addHandler(logging.NullHandler())
