"""What is true in a world, whatever the plant believes: where arms, mobiles and parts are, what was done."""

from .truth import Truth

__all__ = ["Truth"]
