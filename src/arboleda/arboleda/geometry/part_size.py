"""Size of a part as it is drawn, and as `arboleda check` takes it; m."""

PART_RADIUS_M = 0.012
PART_HEIGHT_M = 0.04
