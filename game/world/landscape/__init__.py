"""What stands still in the world: sky, ridges, ground and pads, and how other worlds look."""
