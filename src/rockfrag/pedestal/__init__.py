"""pedestal."""
