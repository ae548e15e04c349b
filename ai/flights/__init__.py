"""Flights on record: how one is noted, what its landing scores, its code for a message, and flying it again."""
