"""Codes of flights: what comes back from one, and what is refused."""

import tracemalloc
import zlib
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ai.flights import letters
from ai.flights.code import BEGIN, END, OPTIONAL, REFUSALS, CodeError, code_of, codes_in, flight_of
from ai.flights.easing import Easing
from ai.flights.key_presses import packed, unpacked
from ai.flights.recording import LONGEST, Recording, StickHolder
from ai.flights.shared import Claim, SharedFlight
from ai.flights.stick import STEPS
from ai.lander.descent import MOST_LEGS, TANK, LegStart
from ai.lander.environment import Outcome
from ai.lander.missions import MISSIONS
from ai.lander.rules import AREAS
from ai.lander.spawns import SPAWNS

PERSON, NETWORK = StickHolder.HUMAN, StickHolder.NETWORK


def shared(actions, hands=None, seed=5, **more):
    """A flight with these actions, and some claim about it."""
    recording = Recording(seed, "random", 1, actions, hands or [PERSON] * len(actions), **more)
    return SharedFlight(recording, Claim(Outcome.LANDED, 84, (0.25, 2.56, -0.0125)))


def sealed(content):
    """The code of any bytes, with the right checksum."""
    return BEGIN + letters.spelt(content + zlib.crc32(content).to_bytes(4, "big")) + END


def refusal(text):
    with pytest.raises(CodeError) as caught:
        flight_of(text)
    return caught.value.kind


legs = st.builds(
    LegStart,
    st.integers(1, MOST_LEGS),
    st.integers(0, round(1000 * TANK)).map(lambda parts: parts / 1000),
    st.booleans(),
)
thrusts = st.tuples(st.integers(0, STEPS), st.integers(-STEPS, STEPS))
runs = st.lists(st.tuples(st.integers(0, 5), st.integers(1, 40)), max_size=30)


@st.composite
def flights(draw):
    actions = [action for action, times in draw(runs) for _ in range(times)]
    cut = draw(st.integers(0, len(actions)))
    hands = [NETWORK] * cut + [PERSON] * (len(actions) - cut)
    steps = draw(st.lists(st.integers(0, LONGEST), unique=True, max_size=4).map(sorted))
    leg = draw(st.none() | legs)
    mission = "" if leg else draw(st.sampled_from(["", *MISSIONS]))
    recording = Recording(
        draw(st.integers(0, 10**40)), draw(st.sampled_from(list(SPAWNS))), 1 if leg else draw(st.sampled_from([1, 3])),
        actions, hands, mission, [] if leg else [(step, draw(st.floats(0.6, 1.4))) for step in steps],
        draw(st.dictionaries(st.integers(0, len(actions) - 1), thrusts, max_size=9)) if actions else {},
        draw(st.builds(Easing, st.booleans(), st.booleans())), draw(st.integers(0, len(AREAS) - 1)), leg,
    )  # fmt: skip
    numbers = st.integers(-(10**6), 10**6).map(lambda number: number / 10_000)
    claim = Claim(draw(st.sampled_from(Outcome)), draw(st.integers(0, 500)), draw(st.tuples(numbers, numbers, numbers)))
    course = mission or draw(st.sampled_from(["", "daily"]))
    return SharedFlight(recording, claim, course, draw(st.sampled_from(["", "helped"])))


@settings(max_examples=60, deadline=None)
@given(flights())
def test_a_flight_comes_back_from_its_code_as_it_was(flight):
    assert flight_of(code_of(flight)) == flight


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(0, 5), max_size=300))
def test_actions_come_back_as_they_were(actions):
    assert unpacked(packed(actions), len(actions)) == actions


def test_the_longest_flight_with_a_change_in_every_step_has_a_code():
    actions = np.random.default_rng(0).integers(0, 6, 2 * 3600).tolist()
    assert flight_of(code_of(shared(actions))).recording.actions == actions


@settings(max_examples=60, deadline=None)
@given(st.binary(max_size=200))
def test_bytes_come_back_from_their_letters(data):
    signs = letters.spelt(data)
    assert letters.read(signs) == data
    assert set(signs) <= set(letters.SIGNS)


def test_a_code_may_be_quoted_wrapped_and_among_other_words():
    code = code_of(shared([0] * 40 + [3] * 90 + [4] * 3))
    wrapped = "\n> ".join(code[start : start + 20] for start in range(0, len(code), 20))
    for text in (
        f"Beat this: “{code}”, if you can - or not!",
        f"> {wrapped}\n> bye",
        f"\u200b{code}\u200b\r\n",
        f"`{code}`",
    ):
        assert flight_of(text) == flight_of(code)


def test_every_code_of_a_text_is_found_and_one_that_is_cut_is_said_to_be():
    one, two = code_of(shared([0, 3])), code_of(shared([0, 4]))
    found = list(codes_in(f"{one}\n{two[:-8]}\n{two}"))
    assert [len(found), found[0], found[2]] == [3, one, two]
    assert refusal(found[1]) == "cut"


def test_what_is_no_flight_is_refused_with_the_reason(subtests):
    for text, kind in [
        ("", "none"),
        ("hello", "none"),
        (BEGIN, "cut"),
        (BEGIN + END, "damaged"),
        (BEGIN + "000" + END, "damaged"),
        (sealed(bytes([9])), "newer"),
        (sealed(bytes([1])), "nonsense"),
        (sealed(bytes([1, OPTIONAL - 1, 0])), "newer"),
        (sealed(bytes([1, OPTIONAL + 9, 0])), "nonsense"),  # passed over, but then there is nothing else
        (sealed(bytes([1, 2, 200])), "nonsense"),
        (sealed(bytes([1, 3, 1, 0])), "nonsense"),  # hands without actions
        (BEGIN + "0" * 60_000 + END, "nonsense"),
    ]:
        with subtests.test(text=text, kind=kind):
            assert refusal(text) == kind
            assert kind in REFUSALS


def test_a_claim_and_a_name_out_of_all_bounds_have_a_code_too():
    flight = replace(shared([0, 3]), barred="ü" * 99, claim=Claim(Outcome.CRASHED, 0, (1e300, -1e306, 0.0)))
    assert flight_of(code_of(flight)).recording == flight.recording


def test_a_wrong_sign_is_found_wherever_it_is():
    code = code_of(shared([0] * 40 + [3] * 90 + [4] * 3))
    for place in range(len(BEGIN), len(code) - len(END)):
        other = "A" if code[place] != "A" else "B"
        assert refusal(code[:place] + other + code[place + 1 :]) == "damaged"


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=120))
def test_any_bytes_with_a_right_checksum_are_a_flight_or_are_refused(content):
    try:
        flight = flight_of(sealed(bytes([1]) + content))
    except CodeError:
        return
    assert len(flight.recording.hands) == len(flight.recording.actions) <= LONGEST


@settings(max_examples=100, deadline=None)
@given(flights(), st.data())
def test_a_flight_with_a_byte_changed_on_purpose_is_a_flight_or_is_refused(flight, data):
    content = bytearray(letters.read(code_of(flight)[len(BEGIN) : -len(END)])[:-4])
    content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    try:
        found = flight_of(sealed(bytes(content)))
    except CodeError:
        return
    assert len(found.recording.actions) <= LONGEST
    assert found.recording.seed <= 10**40


@pytest.mark.parametrize("claimed", [LONGEST, LONGEST + 1, 2**70])
def test_a_code_that_claims_a_long_flight_costs_no_more_than_the_longest(claimed):
    start = bytes([1, 4, 5, 1, 0, 0])
    actions = varint_of(claimed) + bytes([1])
    claim = bytes([5, 5, 1, 0, 0, 0, 0])
    code = sealed(bytes([1]) + start + bytes([2, len(actions)]) + actions + bytes([3, 1, 0]) + claim)
    tracemalloc.start()
    if claimed > LONGEST:
        assert refusal(code) == "nonsense"
    else:
        assert len(flight_of(code).recording.actions) == LONGEST
    assert tracemalloc.get_traced_memory()[1] < 4_000_000
    tracemalloc.stop()


def varint_of(value):
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    return bytes([*out, value])


# The sections of shares of thrust, easing, area and leg: one that says what no flight can be is refused.

START = [bytes([1, 4, 5, 1, 0, 0]), bytes([2, 3, 2, 1, 0]), bytes([3, 1, 0]), bytes([5, 5, 1, 0, 0, 0, 0])]


def with_section(tag, content, start=START[0]):
    """The code of a flight of two steps with one more section."""
    rows = sorted([start, *START[1:], bytes([tag, len(content)]) + content], key=lambda row: row[0])
    return sealed(bytes([1]) + b"".join(rows))


@pytest.mark.parametrize(
    ("tag", "content"),
    [
        (7, bytes([3])),
        (8, bytes([1])),
        (9, varint_of(MOST_LEGS) + varint_of(round(1000 * TANK)) + bytes([1])),
    ],
)
def test_the_utmost_of_each_section_is_read(tag, content):
    assert len(flight_of(with_section(tag, content)).recording.actions) == 2


def test_an_older_section_of_shares_is_read():
    most = (STEPS + 1) * (2 * STEPS + 1)  # all thrust there is
    code = with_section(6, varint_of(most) + varint_of(1) + varint_of(0) + varint_of(1))
    assert flight_of(code).recording.shares == {0: (STEPS, STEPS)}


def test_a_flight_by_sticks_takes_few_letters_and_any_at_all_comes_back():
    steps = np.arange(1200)
    places = np.column_stack([8 + 7.6 * np.sin(steps / 31), 15 * np.sin(steps / 47)]).round().astype(int).tolist()
    shares = {step: (main, side) for step, (main, side) in enumerate(places) if main < STEPS and side}
    flight = shared([0] * 1200, shares=shares)
    assert flight_of(code_of(flight)) == flight
    assert len(code_of(flight)) < 1_000  # a move in two of three steps
    moves = np.random.default_rng(0).integers([0, -STEPS], [STEPS + 1, STEPS + 1], (1200, 2)).tolist()
    flight = shared([0] * 1200, shares=dict(enumerate(map(tuple, moves))))
    assert flight_of(code_of(flight)) == flight


def test_a_section_that_no_flight_can_have_is_refused(subtests):
    for tag, content, kind in [
        (10, b"", "nonsense"),
        (10, bytes([2, 7]), "newer"),
        (6, varint_of((STEPS + 1) * (2 * STEPS + 1) + 1) + varint_of(2), "nonsense"),  # more thrust than there is
        (6, varint_of(5) + varint_of(3), "nonsense"),  # for more steps than are flown
        (6, varint_of(5), "nonsense"),  # for no number of steps
        (6, varint_of(5) + varint_of(2**60), "nonsense"),
        (7, bytes([4]), "nonsense"),
        (7, bytes([1, 1]), "newer"),
        (8, bytes([len(AREAS)]), "newer"),
        (9, bytes([0]) + varint_of(1000) + bytes([0]), "nonsense"),  # legs are counted from one
        (9, varint_of(MOST_LEGS + 1) + varint_of(1000) + bytes([0]), "nonsense"),
        (9, bytes([2]) + varint_of(round(1000 * TANK) + 1) + bytes([0]), "nonsense"),  # more than the tank holds
        (9, bytes([2]) + varint_of(1000) + bytes([2]), "nonsense"),
        (9, bytes([2]), "nonsense"),
        (9, b"", "nonsense"),
    ]:
        with subtests.test(tag=tag, content=content, kind=kind):
            assert refusal(with_section(tag, content)) == kind


@pytest.mark.parametrize("start", [bytes([5, 3, 0, 0]), bytes([5, 1, 0, 4]) + b"fall"])
def test_a_leg_is_no_mission_and_has_a_ground_of_its_own(start):
    assert refusal(with_section(9, bytes([2]) + varint_of(1000) + bytes([0]), bytes([1, len(start)]) + start)) == (
        "nonsense"
    )
