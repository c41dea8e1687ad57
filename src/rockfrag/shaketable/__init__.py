"""shaketable."""
