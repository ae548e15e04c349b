"""Challenges, races and the tutorial, with the ghosts, captions and outcome cards of flights."""
