"""A flight as the game runs it: who flies, what counts, its record, its replay, and what is foreseen of it."""
