"""Values that a file has given: right ones are made a dataclass, the first wrong one is named."""

from dataclasses import dataclass, field
from typing import Annotated, Any

import pytest

from ai.files.schema import OneOf, Share, Sized, Within, check_header, read_as, sound_fields


@dataclass(frozen=True)
class Wheel:
    radius: Annotated[float, Within(0.1, 9)]
    spokes: Annotated[int, Within(3, 60)] = 32


@dataclass(frozen=True)
class Cart:
    name: Annotated[str, Sized(8, least=1)]
    wheels: tuple[Wheel, ...]
    place: tuple[float, int] = (0.0, 0)
    colour: Annotated[str, OneOf(("red", "blue"))] = "red"
    worn: Share | None = None
    locked: bool = False
    load: int | str = 0
    parts: dict[str, int | None] = field(default_factory=dict)
    more: Any = None


WHOLE = {"name": "hay", "wheels": [{"radius": 1}]}


def test_values_become_a_dataclass_and_those_that_are_missing_its_defaults():
    cart = read_as(Cart, WHOLE | {"place": [2, 3], "worn": 1, "load": "hay", "parts": {"axle": 1, "seat": None}})
    assert cart == Cart("hay", (Wheel(1.0),), (2.0, 3), worn=1.0, load="hay", parts={"axle": 1, "seat": None})
    assert isinstance(cart.wheels[0].radius, float)
    assert read_as(Cart, WHOLE | {"worn": None, "more": [{}]}) == Cart("hay", (Wheel(1.0),), more=[{}])


def test_what_is_wrong_is_named_with_its_place(subtests):
    wrong: Any
    for wrong, said in [
        ({"name": 1}, "name: 1 is no text"),
        ({"name": ""}, "name: '' has not a length of 1 to 8"),
        ({"name": "x" * 9}, "not a length of 1 to 8"),
        ({"wheels": {}}, "wheels: {} is no list"),
        ({"wheels": [1]}, "wheels: 0: 1 is no table"),
        ({"wheels": [{"radius": 0}]}, "wheels: 0: radius: 0.0 does not lie between 0.1 and 9"),
        ({"wheels": [{"radius": 1}, {}]}, "wheels: 1: radius is missing"),
        ({"wheels": [{"radius": 1, "spokes": 2}]}, "wheels: 0: spokes: 2 does not lie between 3 and 60"),
        ({"wheels": [{"radius": 1, "spokes": 32.0}]}, "no whole number"),
        ({"wheels": [{"radius": 1, "spokes": True}]}, "no whole number"),
        ({"place": [1, 2, 3]}, "no list of 2"),
        ({"place": [1, "x"]}, "place: 1: 'x'"),
        ({"colour": "green"}, "not one of red, blue"),
        ({"colour": []}, "colour: .* is no text"),
        ({"worn": 1.5}, "does not lie between 0 and 1"),
        ({"worn": float("nan")}, "no finite number"),
        ({"worn": 10**400}, "no finite number"),
        ({"worn": False}, "no finite number"),
        ({"locked": 1}, "neither true nor false"),
        ({"load": 0.5}, "load: 0.5"),
        ({"parts": {"axle": "x"}}, "parts: axle: 'x'"),
        ({"parts": []}, "no table"),
    ]:
        with subtests.test(wrong=wrong, said=said), pytest.raises(ValueError, match=said):
            read_as(Cart, WHOLE | wrong)


def test_a_message_is_short_whatever_a_file_says():
    for wrong in ({"locked": "y" * 1000}, {"parts": {"y" * 1000: "x"}}, {"wheels": ["x"] * 500}):
        with pytest.raises(ValueError, match=next(iter(wrong))) as caught:
            read_as(Cart, WHOLE | wrong)
        assert len(str(caught.value)) < 200


def test_fields_that_are_unknown_are_passed_over():
    assert read_as(Cart, WHOLE | {"bell": 1}) == read_as(Cart, WHOLE)
    with pytest.raises(ValueError, match="no table"):
        read_as(Cart, [])


def test_sound_fields_are_separated_from_the_others():
    right, problems = sound_fields(Cart, {"name": "hay", "worn": 2, "locked": True, "bell": 1})
    assert right == {"name": "hay", "locked": True}
    assert [problem.partition(" ")[0] for problem in problems] == ["wheels", "worn:"]


def test_a_file_says_its_format_and_a_version_that_can_be_read():
    for values, said in (
        ([], "does not say that this is a 'cart'"),
        ({"format": "car", "version": 1}, "'cart'"),
        ({"format": "cart"}, "format version null; this program reads version 2"),
        ({"format": "cart", "version": True}, "version true"),
        ({"format": "cart", "version": "x" * 1000}, "version 'xxx"),
    ):
        with pytest.raises(ValueError, match=said) as caught:
            check_header(values, "cart", 2)
        assert len(str(caught.value)) < 100
    assert check_header({"format": "cart", "version": 2}, "cart", 2)["version"] == 2
