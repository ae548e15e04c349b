"""Top-level package of an installed Tranquility: in a wheel, all other packages lie in this folder."""
