"""What outside code relies on by name: signatures, fields and numbers of actions that may only grow."""

import inspect
from dataclasses import fields

import numpy as np

import engine
from ai import digits, nn
from ai.agent import DeepQAgent, MemoryCell
from ai.copilot import CoPilot
from ai.digits import DigitClassifier
from ai.environment import StepResult
from ai.lander import LanderEnv, Outcome
from ai.lander.pilots import LaggyPilot, NoisyPilot, NoPilot, SensorPilot
from ai.training.config import PRESETS
from ai.training.loop import Progress
from game.core.scene import Pop, Push, Quit, Replace, Scene
from game.scenes.digits.scene import DigitsScene


def parameters(function: object) -> list[str]:
    assert callable(function)
    return [name for name in inspect.signature(function).parameters if name != "self"]


def begin_with(function: object, *names: str) -> bool:
    return parameters(function)[: len(names)] == list(names)


def test_engine():
    assert begin_with(engine.World, "gravity", "batch")
    assert begin_with(engine.World.add, "shape", "position", "angle", "mass", "static", "restitution", "friction")
    drags = {"linear_drag", "quadratic_drag", "angular_drag", "angular_quadratic_drag", "group"}
    assert drags <= set(parameters(engine.World.add))
    body = engine.World().add(engine.Polygon.box(1, 1), (0.0, 2.0), mass=1.0)
    assert body.position.shape == body.velocity.shape == (1, 2)
    assert body.angle.shape == body.angular_velocity.shape == (1,)
    for name in ("mass", "inertia", "apply_force", "apply_torque"):
        assert hasattr(body, name), name
    for name in ("Circle", "Sprite", "Body"):
        assert hasattr(engine, name), name


def test_networks():
    net = nn.NeuralNetwork(*nn.CostFunctions.use_mse()).add_layer(nn.FullyConnectedLayer(4, 3))
    net.add_layer(nn.ActivationLayer(*nn.ActivationFunctions.use_tanh()))
    assert {"epochs", "batch_size", "learning_rate", "sampling"} <= set(parameters(net.train))
    assert net.copy().predict(np.zeros((2, 4), np.float32)).shape == (2, 3)
    for name in ("forward_propagate", "backward_propagate", "predict"):
        assert hasattr(nn.Layer, name), name
    assert issubclass(nn.ModelFormatError, Exception)


def test_lander():
    assert begin_with(LanderEnv, "num_envs", "seed", "spawn", "frame_skip")
    assert [outcome.name for outcome in Outcome] == ["FLYING", "LANDED", "CRASHED", "OUT_OF_BOUNDS", "TIMED_OUT"]
    env = LanderEnv(2, 0)
    assert env.reset().shape == (2, 9)
    result = env.step(np.array([0, 5]))
    assert isinstance(result, StepResult)
    for name in ("observation", "reward", "terminated", "truncated", "outcome"):
        assert len(getattr(result, name)) == 2, name


def test_pilots():
    for pilot in (LaggyPilot, NoisyPilot, SensorPilot):
        assert begin_with(pilot.act, "observation"), pilot
    assert not NoPilot().act(np.zeros((3, 9), np.float32)).any()


def test_agent():
    assert MemoryCell._fields[:5] == ("state", "next_state", "action", "reward", "terminal")
    assert begin_with(DeepQAgent.act, "observation", "epsilon")
    for name in ("q_values", "learn", "save", "load"):
        assert hasattr(DeepQAgent, name), name
    assert {"classic", "modern"} <= PRESETS.keys()


def test_progress_of_a_run():
    assert {
        "steps", "updates", "episodes", "success_rate", "loss", "mean_q", "epsilon", "stage", "steps_per_second",
    } <= {field.name for field in fields(Progress)}  # fmt: skip


def test_digits():
    assert hasattr(digits, "load_mnist")
    assert hasattr(digits, "preprocess")
    for name in ("load", "save", "predict"):
        assert hasattr(DigitClassifier, name), name
    for name in ("canvas_rect", "probabilities"):
        assert hasattr(DigitsScene, name), name


def test_copilot():
    assert begin_with(CoPilot, "agent", "assist", "mode")
    assert begin_with(CoPilot.share, "observation", "pilot_action", "surroundings", "shares", "env")
    assert hasattr(CoPilot, "futures")


def test_scenes():
    for name in ("enter", "exit", "handle_event", "update", "draw"):
        assert hasattr(Scene, name), name
    assert all((Push, Pop, Replace, Quit))
