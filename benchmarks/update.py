"""How long one deep Q-learning update and one decision take, beside PyTorch doing the same on one thread.

    python -m benchmarks.update

An update is the whole of it: next states through the target network, the largest Q of each, states through
the online network, squared error at the chosen actions only, the way back, one step of Adam. A decision is
one observation through the network. PyTorch has its fused Adam, and is measured as it is, compiled (where there is a
C++ compiler; it takes a minute at first) and, for a decision, traced and optimized for inference: the table has the
quickest, and says which. A `learn` is all that the preset modern learns in one decision, from a memory of a million,
drawn uniformly and by priorities. All take turns, ten updates or a hundred decisions each, so that a busy machine slows
all; times are processor time, without that of other work.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import platform
import statistics
import time
from collections.abc import Callable
from contextlib import suppress

import numpy as np

from ai.agent import DeepQAgent, Transition
from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    Adam,
    CostFunctions,
    FullyConnectedLayer,
    LayerNormalisation,
    NeuralNetwork,
)
from ai.training.config import PRESETS

try:
    import torch
except ImportError:
    torch = None

GAMMA = 0.99
ROUNDS = 100

Task = Callable[[], object]


def tanh_network() -> NeuralNetwork:
    return (
        NeuralNetwork(*CostFunctions.use_mse())
        .add_layer(FullyConnectedLayer(9, 128))
        .add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
        .add_layer(FullyConnectedLayer(128, 128))
        .add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
        .add_layer(FullyConnectedLayer(128, 6))
    )


def normalised_network() -> NeuralNetwork:
    return (
        NeuralNetwork(*CostFunctions.use_mse())
        .add_layer(FullyConnectedLayer(9, 64))
        .add_layer(LayerNormalisation(64))
        .add_layer(ActivationLayer(*ActivationFunctions.use_relu()))
        .add_layer(FullyConnectedLayer(64, 64))
        .add_layer(LayerNormalisation(64))
        .add_layer(ActivationLayer(*ActivationFunctions.use_relu()))
        .add_layer(FullyConnectedLayer(64, 6))
    )


def batch_of(size: int) -> tuple[np.ndarray, ...]:
    """Return states, actions, rewards, next states and terminals, as a replay buffer would."""
    rng = np.random.default_rng(size)
    return (
        rng.normal(size=(size, 9)).astype(np.float32),
        rng.integers(0, 6, size),
        rng.normal(size=size).astype(np.float32),
        rng.normal(size=(size, 9)).astype(np.float32),
        (rng.random(size) < 0.1).astype(np.float32),
    )


def our_update(network: NeuralNetwork, size: int) -> Task:
    target, optimizer = network.copy(), Adam(1e-3)
    states, actions, rewards, next_states, terminals = batch_of(size)
    rows, error = np.arange(size), np.zeros((size, 6), np.float32)

    def update() -> None:
        values = target.predict(next_states)
        goal = rewards + GAMMA * (1 - terminals) * values[rows, values.argmax(axis=1)]
        q = network.forward_propagate(states)
        error.fill(0)
        error[rows, actions] = (q[rows, actions] - goal) * (2 / size)
        network.backward_propagate(error)
        optimizer.step(network.values, network.gradients)

    return update


def our_learn(prioritised: bool) -> Task:
    agent = DeepQAgent(config=PRESETS["modern"].changed(prioritised=prioritised))
    states, actions, rewards, next_states, terminals = batch_of(agent.replay.capacity)
    agent.replay.add(Transition(states, next_states, actions, rewards, terminals.astype(bool), 1))
    return agent.learn


def torch_network(normalised: bool = False) -> "torch.nn.Module":
    nn = torch.nn
    if not normalised:
        return nn.Sequential(nn.Linear(9, 128), nn.Tanh(), nn.Linear(128, 128), nn.Tanh(), nn.Linear(128, 6))
    return nn.Sequential(
        *(nn.Linear(9, 64), nn.LayerNorm(64), nn.ReLU()),
        *(nn.Linear(64, 64), nn.LayerNorm(64), nn.ReLU()),
        nn.Linear(64, 6),
    )


def torch_updates(normalised: bool, size: int) -> dict[str, Task]:
    online, target = torch_network(normalised), torch_network(normalised)
    optimizer = torch.optim.Adam(online.parameters(), 1e-3, fused=True)
    states, actions, rewards, next_states, terminals = map(torch.from_numpy, batch_of(size))

    def loss_now() -> "torch.Tensor":
        with torch.no_grad():
            goal = rewards + GAMMA * (1 - terminals) * target(next_states).max(dim=1).values
        q = online(states).gather(1, actions[:, None])[:, 0]
        return torch.nn.functional.mse_loss(q, goal)

    def update(loss_of: Callable[[], "torch.Tensor"]) -> None:
        loss = loss_of()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()

    compiled = torch.compile(loss_now)
    return {"as it is": lambda: update(loss_now), "compiled": lambda: update(compiled)}


def our_decision() -> Task:
    network, observation = tanh_network(), batch_of(1)[0]
    return lambda: network.predict(observation)


def torch_decisions() -> dict[str, Task]:
    network, observation = torch_network().eval(), torch.from_numpy(batch_of(1)[0])

    def deciding(decide: Callable[["torch.Tensor"], object]) -> Task:
        def decision() -> object:
            with torch.inference_mode():
                return decide(observation)

        return decision

    traced = torch.jit.optimize_for_inference(torch.jit.trace(network, observation))
    ways = {"as it is": network, "traced": traced, "compiled": torch.compile(network)}
    return {name: deciding(way) for name, way in ways.items()}


def working(tasks: dict[str, Task]) -> dict[str, Task]:
    """Run each task once; return those that can be run: compiling needs a compiler of C++."""
    found = {}
    for name, task in tasks.items():
        with suppress(Exception):
            task()
            found[name] = task
    return found


def medians(*tasks: Task, calls: int, rounds: int = ROUNDS) -> list[float]:
    """Return the median processor time of each task in microseconds; the tasks take turns of so many calls."""
    times: list[list[float]] = [[] for _ in tasks]
    for measured in [False] * (rounds // 10) + [True] * rounds:
        for task, record in zip(tasks, times, strict=True):
            start = time.process_time()
            for _ in range(calls):
                task()
            if measured:
                record.append((time.process_time() - start) / calls * 1e6)
    return [statistics.median(record) for record in times]


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    versions = f"Python {platform.python_version()}, NumPy {np.__version__}"
    if torch is not None:
        torch.set_num_threads(1)
        versions += f", PyTorch {torch.__version__}"
    print(f"{versions}, one thread; medians of {ROUNDS} turns in µs\n")
    print(f"{'':44}{'ours':>8}{'PyTorch':>10}{'ratio':>8}")

    for size in (64, 256):
        theirs = torch_updates(False, size) if torch is not None else {}
        report(f"update 9-128-128-6 tanh, batch {size}", our_update(tanh_network(), size), theirs, 10)
    theirs = torch_updates(True, 256) if torch is not None else {}
    report("update 9-64-64-6 normalised ReLU, batch 256", our_update(normalised_network(), 256), theirs, 10)
    report("decision 9-128-128-6 tanh", our_decision(), torch_decisions() if torch is not None else {}, 100)

    uniform, prioritised = medians(our_learn(False), our_learn(True), calls=2)
    print(f"\nlearn, uniform {uniform:,.0f} µs, prioritised {prioritised:,.0f} µs: {prioritised / uniform:.2f} times")

    if torch is None:
        print('\nPyTorch is not installed; to compare with it: pip install -e ".[bench]"')


def report(name: str, ours: Task, theirs: dict[str, Task], calls: int) -> None:
    theirs = working(theirs)
    ours_took, *rest = medians(ours, *theirs.values(), calls=calls)
    if not theirs:
        print(f"{name:44}{ours_took:8.1f}{'-':>10}{'-':>8}", flush=True)
        return
    took = dict(zip(theirs, rest, strict=True))
    best = min(took, key=took.__getitem__)
    others = ", ".join(f"{way} {each:.1f}" for way, each in took.items() if way != best)
    print(f"{name:44}{ours_took:8.1f}{took[best]:10.1f}{ours_took / took[best]:8.2f}  {best} ({others})", flush=True)


if __name__ == "__main__":
    main()
