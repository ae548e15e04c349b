"""The one list of networks: the player's, the game's, and the player's own files."""
