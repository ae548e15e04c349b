"""How long one deep Q-learning update and one decision take, beside PyTorch doing the same on one thread.

    python -m benchmarks.update

An update is the whole of it: next states through the target network, the largest Q of each, states through the online
network, squared error at the chosen actions only, the way back, one step of Adam. A decision is one observation through
the network. PyTorch's update has its fused Adam, and is compiled, which needs a C++ compiler and a minute at first; its
decision is traced and optimized for inference: its quickest ways. A `learn` is all that the preset modern learns in one
decision, from a memory of a million, drawn uniformly and by priorities. All take turns, ten updates or a hundred
decisions each, so that a busy machine slows all; times are processor time, without that of other work.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import platform
import statistics
import time
from collections.abc import Callable

import numpy as np

from ai.agent import DeepQAgent, Transition
from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    Adam,
    CostFunctions,
    FullyConnectedLayer,
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


def torch_network() -> "torch.nn.Module":
    nn = torch.nn
    return nn.Sequential(nn.Linear(9, 128), nn.Tanh(), nn.Linear(128, 128), nn.Tanh(), nn.Linear(128, 6))


def torch_update(size: int) -> Task:
    online, target = torch_network(), torch_network()
    optimizer = torch.optim.Adam(online.parameters(), 1e-3, fused=True)
    states, actions, rewards, next_states, terminals = map(torch.from_numpy, batch_of(size))

    def loss_now() -> "torch.Tensor":
        with torch.no_grad():
            goal = rewards + GAMMA * (1 - terminals) * target(next_states).max(dim=1).values
        q = online(states).gather(1, actions[:, None])[:, 0]
        return torch.nn.functional.mse_loss(q, goal)

    compiled = torch.compile(loss_now)

    def update() -> None:
        loss = compiled()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()

    return update


def our_decision() -> Task:
    network, observation = tanh_network(), batch_of(1)[0]
    return lambda: network.predict(observation)


def torch_decision() -> Task:
    network, observation = torch_network().eval(), torch.from_numpy(batch_of(1)[0])
    traced = torch.jit.optimize_for_inference(torch.jit.trace(network, observation))

    def decision() -> object:
        with torch.inference_mode():
            return traced(observation)

    return decision


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
        theirs = torch_update(size) if torch is not None else None
        report(f"update 9-128-128-6 tanh, batch {size}", our_update(tanh_network(), size), theirs, 10)
    report("decision 9-128-128-6 tanh", our_decision(), torch_decision() if torch is not None else None, 100)

    uniform, prioritised = medians(our_learn(False), our_learn(True), calls=2)
    print(f"\nlearn, uniform {uniform:,.0f} µs, prioritised {prioritised:,.0f} µs: {prioritised / uniform:.2f} times")

    if torch is None:
        print('\nPyTorch is not installed; to compare with it: pip install -e ".[bench]"')


def report(name: str, ours: Task, theirs: Task | None, calls: int) -> None:
    took, *rest = medians(*filter(None, (ours, theirs)), calls=calls)
    beside = f"{rest[0]:10.1f}{took / rest[0]:8.2f}" if rest else ""
    print(f"{name:44}{took:8.1f}{beside}", flush=True)


if __name__ == "__main__":
    main()
