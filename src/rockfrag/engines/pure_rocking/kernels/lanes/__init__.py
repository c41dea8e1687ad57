"""Ensembles: many cases side by side, in lanes that one step of straight-line arithmetic advances together."""
