"""The cockpit: what a player chooses before a flight, and all that shows how the stick is shared."""
