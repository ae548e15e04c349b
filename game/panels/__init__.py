"""What explains a network or a run: its values, its charts, its settings, its rewards."""
