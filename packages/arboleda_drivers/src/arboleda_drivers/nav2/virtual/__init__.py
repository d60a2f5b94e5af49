"""A virtual base that Nav2 drives: `arboleda virtual nav2`."""
