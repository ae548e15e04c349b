"""Train: a run of landers or of digits, its knobs, charts, experiments and network."""
