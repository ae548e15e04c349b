"""The lander as an environment of Gymnasium. Needs the extra `gym`."""
