"""The recipes that come with Arboleda."""
