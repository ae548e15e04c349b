"""What is shown over a flight: read-outs, cards, and how the stick is shared."""
