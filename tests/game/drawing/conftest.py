import pytest

from tests.support.written import Written


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> Written:
    """Notes of everything that is written from now on, and where."""
    return Written(monkeypatch.setattr)
