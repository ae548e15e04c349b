"""Drawing digits: the pad, what a network reads of it, and pictures of how it knows."""
