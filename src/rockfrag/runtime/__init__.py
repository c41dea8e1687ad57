"""How jobs run on a machine: processes, locks, machine code that is compiled once."""
