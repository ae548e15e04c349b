"""Cockpit: read-outs and cards over a flight, and the display of shared control with the co-pilot."""
