"""All that belongs to one thesis, “Rocking instability of rigid blocks atop a small pedestal”."""
