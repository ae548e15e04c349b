"""A network edited by hand: what an edit changes, what is refused, and the way back, bit for bit."""

from inspect import getgeneratorlocals
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ai.agent.agent import DeepQAgent
from ai.explain.inspection import links
from ai.nn import NeuralNetwork
from ai.training.config import PRESETS, Config
from ai.training.edits import EDITED, Edit, NetworkEditor, NetworkEdits
from ai.training.history import Point, SettingChange
from ai.training.lander_session import LanderSession
from ai.training.messages import NetworkState
from tests.support.small import LANDERS

SENSED = np.linspace(-1, 1, 18, dtype=np.float32).reshape(2, 9)


def agent_of(**options: object) -> DeepQAgent:
    agent = DeepQAgent(config=PRESETS["modern"].changed(hidden=(5, 4), **options))
    agent.target.values = agent.online.values * np.float32(0.9)  # they differ while it learns
    return agent


def both(agent: DeepQAgent) -> tuple[bytes, bytes]:
    return agent.online.values.tobytes(), agent.target.values.tobytes()


UNITS, LAYERS = st.integers(0, 3), st.integers(0, 2)
EDITS: st.SearchStrategy[Edit] = st.one_of(
    st.builds(Edit, LAYERS, UNITS),
    st.builds(Edit, LAYERS, UNITS, UNITS),
)


@given(st.lists(EDITS, min_size=1, max_size=25))
def test_each_step_is_undone_bit_for_bit(edits: list[Edit]) -> None:
    agent = agent_of()
    editor, before = NetworkEditor(agent), []
    for edit in edits:
        before.append(both(agent))
        editor.apply(edit)
        assert agent.paused
    while editor.edits.steps:
        editor.undo()
        assert both(agent) == before.pop()
    assert not before
    assert editor.edits == NetworkEdits()
    assert not agent.paused


@pytest.mark.parametrize("options", [{}, {"dueling": True}, {"layer_normalisation": False, "activation": "tanh"}])
def test_a_silenced_unit_makes_no_difference_any_more(options: dict[str, object]) -> None:
    agent = agent_of(**options)
    NetworkEditor(agent).apply(Edit(0, 2))
    other = SENSED.copy()
    other[:, 2] = 9.0
    for network in (agent.online, agent.target):
        assert np.array_equal(network.predict(SENSED), network.predict(other))
    NetworkEditor(agent).apply(Edit(2, 1))
    assert not links(agent.online)[2].weights[1].any()


def test_a_link_is_cut_and_no_other_changes() -> None:
    agent = agent_of()
    before = [link.weights.copy() for link in links(agent.online)]
    NetworkEditor(agent).apply(Edit(1, 4, 3))
    before[1][4, 3] = 0.0
    for network in (agent.online, agent.target):
        assert links(network)[1].weights[4, 3] == 0.0
    for weights, link in zip(before, links(agent.online), strict=True):
        assert np.array_equal(weights, link.weights)


def test_what_cannot_be_edited_is_refused_and_nothing_changes(subtests: pytest.Subtests):
    for edit, said in [
        (Edit(0, 9), "no weight 9"),
        (Edit(0, -1), "no weight -1"),
        (Edit(3, 0), "no outgoing weights"),
        (Edit(7, 0), "no layer 7"),
        (Edit(-1, 0, 0), "no layer -1"),
        (Edit(0, 0, 5), "no weight 0, 5"),
        (Edit(2, 0, 0), "dueling"),
    ]:
        with subtests.test(edit=edit, said=said):
            agent = agent_of(dueling=said == "dueling")
            editor, before = NetworkEditor(agent), both(agent)
            with pytest.raises(ValueError, match=said):
                editor.apply(edit)
            assert both(agent) == before
            assert not agent.paused


def of_kind(messages: tuple[object, ...], kind: type) -> list[object]:
    return [message for message in messages if isinstance(message, kind)]


def state(messages: tuple[object, ...]) -> bytes:
    [state] = of_kind(messages, NetworkState)
    return state.values.tobytes()  # type: ignore[attr-defined]


def weights_of(config: Config, values: bytes) -> list[np.ndarray]:
    agent = DeepQAgent(config=config)
    agent.online.values = np.frombuffer(values, np.float32)
    return [link.weights.copy() for link in links(agent.online)]


def test_a_live_run_is_edited_flies_on_without_learning_and_is_as_it_was() -> None:
    run = LanderSession.live(LANDERS, 3)
    next(run)
    for _ in range(60):
        next(run)
    before = state(run.send(("undo",)))  # there is nothing to undo: it only says how things stand
    messages = run.send(("edit", Edit(1, 3)))
    assert not weights_of(LANDERS, state(messages))[1][3].any()
    assert of_kind(messages, NetworkEdits) == [NetworkEdits(((1, 3, None),), 1, True, True)]
    [change] = of_kind(messages, SettingChange)
    assert isinstance(change, SettingChange)
    assert (change.name, change.before, change.after) == (EDITED, 0, 1)
    edited = state(messages)
    flown = [message for _ in range(40) for message in next(run)]
    assert {state.values.tobytes() for state in flown if isinstance(state, NetworkState)} <= {edited}
    points = [message for message in flown if isinstance(message, Point)]
    assert points
    assert all(np.isnan(point.loss) for point in points)
    optimizer = getgeneratorlocals(run)["session"].training.agent.optimizer
    messages = run.send(("undo", True))
    assert state(messages) == before
    assert getgeneratorlocals(run)["session"].training.agent.optimizer is optimizer, "it has not learnt meanwhile"
    assert of_kind(messages, NetworkEdits) == [NetworkEdits()]
    for _ in range(10):
        next(run)
    assert state(run.send(("undo",))) != before, "it learns again"
    run.send(("edit", Edit(0, 0)))
    run.send(("restore", 0))
    assert of_kind(run.send(("undo",)), NetworkEdits) == [NetworkEdits()], "a checkpoint replaces what was edited"
    run.close()


def test_it_learns_on_from_an_edit_and_can_still_go_back() -> None:
    run = LanderSession.live(LANDERS, 3)
    for _ in range(60):
        next(run)
    before = state(run.send(("undo",)))
    edited = state(run.send(("edit", Edit(0, 1, 2))))
    [edits] = of_kind(run.send(("learn_on",)), NetworkEdits)
    assert edits == NetworkEdits(way_back=True)
    run.send(("edit", Edit(0, 2)))
    assert of_kind(run.send(("undo",)), NetworkEdits) == [NetworkEdits(way_back=True)], (
        "also once a later edit is undone"
    )
    for _ in range(10):
        next(run)
    assert state(run.send(("undo",))) not in (before, edited)
    training = getgeneratorlocals(run)["session"].training
    optimizer = training.agent.optimizer
    assert state(run.send(("undo", True))) == before
    assert training.agent.optimizer is not optimizer, "what it remembers belongs to other weights"
    run.close()


def test_a_run_that_ends_while_it_is_edited_is_saved_as_it_was(tmp_path: Path) -> None:
    run = LanderSession.live(LANDERS, 3, keep=tmp_path / "run")
    for _ in range(60):
        next(run)
    before = state(run.send(("undo",)))
    run.send(("edit", Edit(0, 0)))
    next(run)
    run.close()
    assert NeuralNetwork.load(tmp_path / "run" / "last" / "online").values.tobytes() == before
