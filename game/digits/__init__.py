"""Handwritten digits, as several screens show them: pictures, cells to pick, networks kept in memory."""


def certainty(value: float) -> str:
    """Write how sure a network is, in percent: never 100 %, since no answer is certain."""
    return f"{min(100 * value, 99.9):.1f} %" if value > 0.995 else f"{100 * value:.0f} %"
