from game.flight.flight_file import Entry
from game.flight.skill import Skill


def flown(landed: bool, *, alone: bool, **more) -> Entry:
    return Entry(0.0, "LANDED" if landed else "CRASHED", 7.0, 3.0, 0.4, 1.0, alone, **more)


ALONE, HELPED = flown(True, alone=True), flown(True, alone=False)


def test_only_free_flights_say_something_of_it():
    skill = Skill([flown(True, alone=True, score=80), flown(True, alone=True, score=90, course="night")])
    skill.add(flown(False, alone=True))
    skill.add(flown(True, alone=True, score=95, course="night"))
    assert skill.own == [True, False]
    assert skill.best == 80
    assert Skill([]).best == 0


def test_what_the_network_landed_is_not_the_players_best():
    assert Skill([flown(True, alone=True, score=60), flown(True, alone=False, score=90)]).best == 60


def test_every_fifth_flight_is_a_check_and_one_flown_alone_counts_as_such():
    skill = Skill([])
    due = []
    for number in range(12):
        due.append(skill.check_due)
        skill.add(ALONE if skill.check_due or number == 6 else HELPED)
    assert [number for number, check in enumerate(due) if check] == [4, 11]


def test_a_check_that_was_skipped_comes_again_after_as_many_flights():
    skill = Skill([HELPED] * 4)
    assert skill.check_due
    skill.skip_check()
    due = []
    for _ in range(5):
        due.append(skill.check_due)
        skill.add(HELPED)
    assert due == [False, False, False, False, True]


def test_checks_are_seldom_once_it_is_well_known_how_often_the_player_would_land():
    skill = Skill([flown(True, alone=True)] * 60 + [HELPED] * 4)
    estimate = skill.becoming.estimate("plain")
    assert estimate.high - estimate.low < 0.2
    due = []
    for _ in range(6):
        due.append(skill.check_due)
        skill.add(HELPED)
    assert due == [False] * 5 + [True]
