"""How long one deep Q-learning update and one decision take, beside PyTorch doing the same on one thread.

    python -m benchmarks.update

An update is the whole of it: next states through the target network, the largest Q of each, states through
the online network, squared error at the chosen actions only, the way back, one step of Adam. A decision is
one observation through the network. Both sides take turns, so that a busy machine slows both.
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
ROUNDS = 600


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
        goal = rewards + GAMMA * (1 - terminals) * target.predict(next_states).max(axis=1)
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


def medians(*tasks: Callable[[], object], calls: int = 1) -> list[float]:
    """Return the median time of each task in microseconds; the tasks take turns."""
    times: list[list[float]] = [[] for _ in tasks]
    for measured in [False] * (ROUNDS // 10) + [True] * ROUNDS:
        for task, record in zip(tasks, times, strict=True):
            start = time.perf_counter()
            for _ in range(calls):
                task()
            if measured:
                record.append((time.perf_counter() - start) / calls * 1e6)
    return [statistics.median(record) for record in times]


def main() -> None:
    versions = f"Python {platform.python_version()}, NumPy {np.__version__}"
    if torch is not None:
        torch.set_num_threads(1)
        versions += f", PyTorch {torch.__version__}"
    print(f"{versions}, one thread; medians of {ROUNDS} in µs\n")
    print(f"{'':42}{'ours':>8}{'PyTorch':>10}{'ratio':>8}")

    deep = [("9-128-128-6 tanh", tanh_network, False, size) for size in (64, 256)]
    normal = [("9-64-64-6 normalised ReLU", normalised_network, True, 256)]
    rows = [
        (f"update {name}, batch {size}", 1, our_update(make(), size), lambda n=n, s=size: torch_update(n, s))
        for name, make, n, size in deep + normal
    ]
    rows.append(("decision 9-128-128-6 tanh", 20, our_decision(), torch_decision))
    for name, calls, ours, theirs in rows:
        times = medians(ours, *([theirs()] if torch is not None else []), calls=calls)
        compared = (
            f"{times[1]:10.1f}{times[0] / times[1]:8.2f}" if torch is not None else f"{'-':>10}{'-':>8}"
        )
        print(f"{name:42}{times[0]:8.1f}{compared}")
    if torch is None:
        print('\nPyTorch is not installed; to compare with it: pip install "tranquility[bench]"')


if __name__ == "__main__":
    main()
