"""Keys, gamepads and the mouse, turned into what a pilot holds and what a player commands."""
