"""Draft of a plant: its files with changes that nothing runs yet, kept through a crash."""
