"""Property tests draw the same examples every time: a suite that passed passes again. One thread each is enough."""

from main import limit_threads

limit_threads()

from hypothesis import settings  # noqa: E402

settings.register_profile("same", derandomize=True)
settings.load_profile("same")
