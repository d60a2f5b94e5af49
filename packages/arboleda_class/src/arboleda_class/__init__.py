"""Arboleda for a class: a plant in a tab of a browser, exercises with a judge, and a world for notebooks."""
