"""Storage recipes, as the simulator judges them: tasks step by step, grips, parts and racks."""
