"""What every screen shares: tokens, type, the canvas, widgets and focus."""
