"""What a flight is flown as, besides flying: a challenge, a race, the tutorial; its ghost, captions and end."""
