"""rocking."""
