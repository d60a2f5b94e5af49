"""`arboleda prove`: each single fault at each instant of each recipe, one run each."""
