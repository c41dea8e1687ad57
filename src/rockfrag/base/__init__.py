"""What every room stands on: errors, files, units, tables that people write, arithmetic, the look of figures."""
