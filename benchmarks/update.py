"""How long one deep Q-learning update and one decision take, beside PyTorch doing the same on one thread.

    python -m benchmarks.update

An update is the whole of it: next states through the target network, the largest Q of each, states through
the online network, squared error at the chosen actions only, the way back, one step of Adam. A decision is
one observation through the network. Both sides take turns, ten updates or a hundred decisions each, so that a
busy machine slows both; times are processor time, without that of other work.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import platform
import statistics
import time
from collections.abc import Callable

import numpy as np

from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    Adam,
    CostFunctions,
    FullyConnectedLayer,
    LayerNormalisation,
    NeuralNetwork,
)

try:
    import torch
except ImportError:
    torch = None

GAMMA = 0.99
ROUNDS = 100


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


def our_update(network: NeuralNetwork, size: int) -> Callable[[], object]:
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


def torch_network(normalised: bool = False) -> "torch.nn.Module":
    nn = torch.nn
    if not normalised:
        return nn.Sequential(nn.Linear(9, 128), nn.Tanh(), nn.Linear(128, 128), nn.Tanh(), nn.Linear(128, 6))
    return nn.Sequential(
        *(nn.Linear(9, 64), nn.LayerNorm(64), nn.ReLU()),
        *(nn.Linear(64, 64), nn.LayerNorm(64), nn.ReLU()),
        nn.Linear(64, 6),
    )


def torch_update(normalised: bool, size: int) -> Callable[[], object]:
    online, target = torch_network(normalised), torch_network(normalised)
    optimizer = torch.optim.Adam(online.parameters(), 1e-3)
    states, actions, rewards, next_states, terminals = map(torch.from_numpy, batch_of(size))

    def update() -> None:
        with torch.no_grad():
            goal = rewards + GAMMA * (1 - terminals) * target(next_states).max(dim=1).values
        q = online(states).gather(1, actions[:, None])[:, 0]
        loss = torch.nn.functional.mse_loss(q, goal)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()

    return update


def our_decision() -> Callable[[], object]:
    network, observation = tanh_network(), batch_of(1)[0]
    return lambda: network.predict(observation)


def torch_decision() -> Callable[[], object]:
    network, observation = torch_network(), torch.from_numpy(batch_of(1)[0])

    def decide() -> object:
        with torch.no_grad():
            return network(observation)

    return decide


def medians(*tasks: Callable[[], object], calls: int, rounds: int = ROUNDS) -> list[float]:
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
    versions = f"Python {platform.python_version()}, NumPy {np.__version__}"
    if torch is not None:
        torch.set_num_threads(1)
        versions += f", PyTorch {torch.__version__}"
    print(f"{versions}, one thread; medians of {ROUNDS} turns in µs\n")
    print(f"{'':44}{'ours':>8}{'PyTorch':>10}{'ratio':>8}")

    for size in (64, 256):
        theirs = torch_update(False, size) if torch is not None else None
        report(f"update 9-128-128-6 tanh, batch {size}", our_update(tanh_network(), size), theirs, 10)
    theirs = torch_update(True, 256) if torch is not None else None
    report("update 9-64-64-6 normalised ReLU, batch 256", our_update(normalised_network(), 256), theirs, 10)
    theirs = torch_decision() if torch is not None else None
    report("decision 9-128-128-6 tanh", our_decision(), theirs, 100)

    if torch is None:
        print('\nPyTorch is not installed; to compare with it: pip install -e ".[bench]"')


def report(name: str, ours: Callable[[], object], theirs: Callable[[], object] | None, calls: int) -> None:
    if theirs is None:
        (time_of_ours,) = medians(ours, calls=calls)
        print(f"{name:44}{time_of_ours:8.1f}{'-':>10}{'-':>8}")
    else:
        time_of_ours, time_of_theirs = medians(ours, theirs, calls=calls)
        print(f"{name:44}{time_of_ours:8.1f}{time_of_theirs:10.1f}{time_of_ours / time_of_theirs:8.2f}")


if __name__ == "__main__":
    main()
