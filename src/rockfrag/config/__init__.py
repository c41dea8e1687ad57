"""What a file of settings may hold: the schema of each kind, and what plugins add to it."""
