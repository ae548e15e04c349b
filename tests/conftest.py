"""Property tests draw the same examples every time: a suite that passed passes again."""

from hypothesis import settings

settings.register_profile("same", derandomize=True)
settings.load_profile("same")
