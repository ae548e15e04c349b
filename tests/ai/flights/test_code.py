"""Codes of flights: what comes back from one, and what is refused."""

import base64
import json
import tracemalloc
import zlib
from dataclasses import replace
from itertools import starmap
from string import ascii_letters
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from ai.flights import code as module
from ai.flights.code import BEGIN, END, CodeError, code_of, codes_in, flight_of
from ai.flights.recording import LONGEST, Claim, ClaimedFlight, Easing, Recording, StickHolder
from ai.lander.descent import MOST_LEGS, TANK, LegStart
from ai.lander.environment import Outcome
from ai.lander.missions import MISSIONS
from ai.lander.push import KEYS, STEPS, Push
from ai.lander.spawns import SPAWNS
from game.core import texts

PERSON, NETWORK = StickHolder.HUMAN, StickHolder.NETWORK
BEFORE = "tranq-0El98Tx0gY33g4kBpSYG2sdlf4lym4X0rTvkkctsEWo1k-over"  # of the game's first version


def shared(pushes, hands=None, seed=5, **more):
    """A flight with these pushes, or with the actions of keys, and some claim about it."""
    pushes = [push if isinstance(push, Push) else KEYS[push] for push in pushes]
    recording = Recording(seed, "random", pushes=pushes, hands=hands or [PERSON] * len(pushes), **more)
    return ClaimedFlight(recording, Claim(Outcome.LANDED, 84, (0.25, 2.56, -0.0125)))


def sealed(data):
    """The code of any bytes, with the right checksum."""
    data += zlib.crc32(data).to_bytes(4, "big")
    return BEGIN + base64.b64encode(data, b"+.").decode().rstrip("=") + END


def deflated(content):
    packer = zlib.compressobj(9, wbits=-15, zdict=module._USUAL)
    return packer.compress(content) + packer.flush()


def content_of(flight):
    """The start and the inputs of a flight as its code has them."""
    signs = code_of(flight)[len(BEGIN) : -len(END)]
    data = base64.b64decode(signs + "=" * (-len(signs) % 4), b"+.")[:-4]
    line, _, inputs = zlib.decompressobj(-15, zdict=module._USUAL).decompress(data).partition(b"\n")
    return json.loads(line), inputs


def remade(values, inputs):
    """The code of a start and inputs."""
    return sealed(deflated(json.dumps(values).encode() + b"\n" + inputs))


def refusal(text):
    """Why a text is refused; "" if it is a flight."""
    try:
        flight_of(text)
    except CodeError as error:
        return error.kind if texts.CODE_REFUSED[error.kind] else "no words"
    return ""


legs = st.builds(LegStart, st.integers(1, MOST_LEGS), st.floats(0, TANK), st.booleans())
thrusts = st.tuples(st.integers(0, STEPS), st.integers(-STEPS, STEPS))
runs = st.lists(st.tuples(st.integers(0, 5), st.sampled_from([PERSON, NETWORK]), st.integers(1, 60)), max_size=30)


@st.composite
def flights(draw):
    steps = [(KEYS[action], hand) for action, hand, times in draw(runs) for _ in range(times)]
    pushes = [push for push, _ in steps]
    leg = draw(st.none() | legs)
    mission = "" if leg else draw(st.sampled_from(["", *MISSIONS]))
    sticks = st.dictionaries(st.integers(0, len(steps) - 1), thrusts, max_size=9) if steps else st.just({})
    for step, push in draw(sticks).items():
        pushes[step] = Push(*push)
    recording = Recording(
        draw(st.integers(0, 2**128)), draw(st.sampled_from(list(SPAWNS))), 1 if leg else draw(st.sampled_from([1, 3])),
        mission, draw(st.builds(Easing, st.booleans(), st.booleans())), leg, pushes,
        [hand for _, hand in steps],
    )  # fmt: skip
    numbers = st.integers(-(10**6), 10**6).map(lambda number: number / 10_000)
    claim = Claim(draw(st.sampled_from(Outcome)), draw(st.integers(0, 500)), draw(st.tuples(numbers, numbers, numbers)))
    course = mission or draw(st.sampled_from(["", "daily"]))
    return ClaimedFlight(recording, claim, course, draw(st.sampled_from(["", "helped"])))


@settings(max_examples=60, deadline=None)
@given(flights())
def test_a_flight_comes_back_from_its_code_as_it_was(flight):
    assert flight_of(code_of(flight)) == flight


def test_the_longest_flight_with_a_change_in_every_step_has_a_code():
    rng = np.random.default_rng(0)
    places = rng.integers([1, -STEPS], [STEPS, STEPS], (LONGEST, 2)).tolist()
    flight = shared(list(starmap(Push, places)))
    assert flight_of(code_of(flight)) == flight


def test_a_flight_takes_few_letters():
    rng = np.random.default_rng(0)
    taps = np.repeat(rng.integers(0, 6, 60), rng.integers(3, 18, 60)).tolist()
    assert len(taps) > 600, "ten seconds"
    assert len(code_of(shared(taps, seed=2**31 - 1))) < 200
    steps = np.arange(600)
    places = np.column_stack([8 + 7.6 * np.sin(steps / 31), 15 * np.sin(steps / 47)]).round().astype(int).tolist()
    assert len(code_of(shared(list(starmap(Push, places))))) < 600


def test_a_code_may_be_quoted_wrapped_and_among_other_words():
    code = code_of(shared([0] * 40 + [3] * 90 + [4] * 3))
    wrapped = "\n> ".join(code[start : start + 20] for start in range(0, len(code), 20))
    for text in (
        f"Beat: “{code}” - or not!",
        f"> {wrapped}\n> bye",
        f"\u200b{code}\u200b\r\n",
        f"`{code}`",
    ):
        assert flight_of(text) == flight_of(code)


def test_every_code_of_a_text_is_found_and_one_that_is_cut_is_said_to_be():
    one, two = code_of(shared([0, 3])), code_of(shared([0, 4]))
    found = list(codes_in(f"{one}\n{two[:-8]}\n{two}{BEFORE}"))
    assert [found[0], *found[2:]] == [one, two, BEFORE]
    assert refusal(found[1]) == "cut"


def test_what_is_no_flight_is_refused_with_the_reason(subtests):
    for text, kind in [
        ("", "none"),
        ("hello", "none"),
        (BEGIN, "cut"),
        (BEGIN + END, "damaged"),
        (BEGIN + "0000000" + END, "damaged"),
        (BEGIN + "0" + END, "damaged"),
        (BEFORE, "older"),
        ("tranq-", "older"),
        ("tranq5-000-over", "newer"),
        (sealed(b""), "nonsense"),
        (sealed(b"\xff" * 9), "nonsense"),
        (sealed(deflated(b"")), "nonsense"),
        (sealed(deflated(b"[" * 5000)), "nonsense"),
        (sealed(deflated(b"{}\n") + b"more"), "nonsense"),
    ]:
        with subtests.test(text=text):
            assert refusal(text) == kind


def test_a_wrong_sign_is_found_wherever_it_is():
    code = code_of(shared([0] * 40 + [3] * 90 + [4] * 3))
    for place in range(len(BEGIN), len(code) - len(END)):
        last = place == len(code) - len(END) - 1
        for other in ascii_letters if last else "A.":
            if other != code[place]:
                assert refusal(code[:place] + other + code[place + 1 :]) == "damaged"


def test_a_claim_and_a_name_out_of_all_bounds_have_a_code_too():
    flight = replace(shared([0, 3]), barred="ü" * 99, claim=Claim(Outcome.CRASHED, 0, (1e300, -1e306, 0.0)))
    assert flight_of(code_of(flight)).recording == flight.recording


def test_a_start_or_a_claim_that_no_flight_can_have_is_refused(subtests):
    values, inputs = content_of(shared([0, 3]))
    sound = {"leg": [MOST_LEGS, TANK, True], "easing": {"wider_pads": True, "untimed": True}}
    wrong = {
        "seed": (-1, 10**40 + 1, "x", 1.5), "pads": (2, "1"), "spawn": ("nowhere",), "mission": ("nowhere", 3),
        "easing": (True, None),
        "leg": ([0, 1.0, False], [MOST_LEGS + 1, 1.0, False], [2, TANK + 0.001, False], [2, 1.0], [2, 1.0, 2]),
        "outcome": ("WON",), "points": (-1, 10**7), "end": ([0, 0], [0, 0, 10**11]), "course": ("elsewhere",),
        "barred": ("x" * 41,),
    }  # fmt: skip
    assert [refusal(remade(values | {name: value}, inputs)) for name, value in sound.items()] == ["", ""]
    on_a_leg: dict[str, Any] = {"pads": 3, "mission": "fall"}
    changes: list[dict[str, Any]] = [{name: value} for name, values in wrong.items() for value in values]
    changes += [{"leg": [2, 1.0, False], name: value} for name, value in on_a_leg.items()]
    for change in changes:
        with subtests.test(change=change):
            assert refusal(remade(values | change, inputs)) == "nonsense"


def test_sticks_move_within_their_ways_and_in_every_step(subtests):
    values, _ = content_of(shared([0, 3]))
    for moves, kind in [
        (bytes([STEPS, 0, STEPS, 0]), ""),
        (bytes([STEPS, 0, 256 - STEPS, 2 * STEPS]), ""),
        (bytes([STEPS + 1, 0, 0, 0]), "nonsense"),
        (bytes([STEPS, 1, 0, 0]), "nonsense"),
        (bytes([255, 0, 0, 0]), "nonsense"),
        (bytes([0, 0, STEPS, 1]), "nonsense"),
        (bytes([0, 0, 0]), "nonsense"),
        (b"", "nonsense"),
    ]:
        with subtests.test(moves=moves):
            assert refusal(remade(values, bytes([0, 0, 255]) + moves)) == kind


@settings(max_examples=100, deadline=None)
@given(flights(), st.data())
def test_a_flight_changed_on_purpose_is_a_flight_or_is_refused(flight, data):
    """A byte of its deflated content, of what that unfolds to, or any bytes at all: the checksum is right."""
    values, inputs = content_of(flight)
    content = bytearray(json.dumps(values).encode() + b"\n" + inputs)
    packed = data.draw(st.booleans())
    changed = bytearray(deflated(bytes(content))) if packed else content
    if data.draw(st.booleans()):
        changed[data.draw(st.integers(0, len(changed) - 1))] = data.draw(st.integers(0, 255))
    else:
        changed = data.draw(st.binary(max_size=120))
    try:
        found = flight_of(sealed(bytes(changed) if packed else deflated(bytes(changed))))
    except CodeError:
        return
    assert len(found.recording.hands) == len(found.recording.pushes) <= LONGEST
    assert found.recording.seed < 10**40


def test_a_code_that_unfolds_to_more_than_the_longest_flight_costs_no_more():
    values, _ = content_of(shared([0, 3]))
    for times, kind in ((LONGEST // 21, ""), (LONGEST // 21 + 1, "nonsense"), (10**7, "nonsense")):
        code = remade(values, bytes([240]) * times)
        tracemalloc.start()
        assert refusal(code) == kind
        assert tracemalloc.get_traced_memory()[1] < 8_000_000
        tracemalloc.stop()
