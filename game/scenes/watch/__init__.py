"""Watching a network fly: a swarm, what one of its landers weighs, and a hand that places it elsewhere."""
