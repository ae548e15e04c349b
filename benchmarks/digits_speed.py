"""How long networks for digits take to train and to guess, beside PyTorch doing the same on one thread.

    python -m benchmarks.digits_speed

The convolutional network is 5x5x16, ReLU, pool, 5x5x32, ReLU, pool, 128, ReLU, 10 with softmax cross-entropy;
a step is 100 images of 28 x 28 forward, backward, and plain gradient descent. PyTorch is
measured in its default layout and in channels_last. The dense network is
784-100-50-10, tanh, squared error; an epoch is 60,000 images in batches of 500. All sides take turns, so that a
busy machine slows all.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import platform
from collections.abc import Callable
from math import prod

import numpy as np

from ai.nn import (
    SGD,
    ActivationFunctions,
    ActivationLayer,
    ConvolutionLayer,
    CostFunctions,
    FlattenLayer,
    FullyConnectedLayer,
    MaxPoolingLayer,
    NeuralNetwork,
)
from benchmarks.update import medians

try:
    import torch
except ImportError:
    torch = None

BATCH, RATE = 100, 0.01
Task = Callable[[], object]


def convolutional_network() -> NeuralNetwork:
    network, shape = NeuralNetwork(*CostFunctions.use_softmax_cross_entropy()), (28, 28, 1)
    for filters in (16, 32):
        convolution = ConvolutionLayer(shape, filters, kernel=5)
        pooling = MaxPoolingLayer(convolution.outputs)
        network.add_layer(convolution).add_layer(ActivationLayer(*ActivationFunctions.use_relu())).add_layer(pooling)
        shape = pooling.outputs
    network.add_layer(FlattenLayer(shape)).add_layer(FullyConnectedLayer(prod(shape), 128))
    network.add_layer(ActivationLayer(*ActivationFunctions.use_relu()))
    return network.add_layer(FullyConnectedLayer(128, 10))


def dense_network() -> NeuralNetwork:
    network, tanh = NeuralNetwork(*CostFunctions.use_mse()), ActivationFunctions.use_tanh()
    for inputs, outputs in ((784, 100), (100, 50), (50, 10)):
        network.add_layer(FullyConnectedLayer(inputs, outputs)).add_layer(ActivationLayer(*tanh))
    return network


def torch_convolutional(layout: "torch.memory_format") -> "torch.nn.Module":
    nn = torch.nn
    return nn.Sequential(
        *(nn.Conv2d(1, 16, 5), nn.ReLU(), nn.MaxPool2d(2)),
        *(nn.Conv2d(16, 32, 5), nn.ReLU(), nn.MaxPool2d(2)),
        *(nn.Flatten(), nn.Linear(32 * 4 * 4, 128), nn.ReLU(), nn.Linear(128, 10)),
    ).to(memory_format=layout)


def torch_dense() -> "torch.nn.Module":
    nn = torch.nn
    return nn.Sequential(
        *(nn.Linear(784, 100), nn.Tanh(), nn.Linear(100, 50), nn.Tanh(), nn.Linear(50, 10), nn.Tanh()),
    )


def digits(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return images (count, 784) of noise and one-hot rows (count, 10)."""
    rng = np.random.default_rng(0)
    return rng.random((count, 784), np.float32), np.eye(10, dtype=np.float32)[rng.integers(0, 10, count)]


def convolution_steps() -> list[Task]:
    x, y = digits(BATCH)
    network, optimizer, images = convolutional_network(), SGD(RATE), x.reshape(-1, 28, 28, 1)
    tasks: list[Task] = [lambda: network.train_batch(images, y, optimizer)]
    if torch is not None:
        labels = torch.from_numpy(y.argmax(axis=1))
        for layout in (torch.contiguous_format, torch.channels_last):
            model = torch_convolutional(layout)
            theirs = torch.from_numpy(x).reshape(-1, 1, 28, 28).to(memory_format=layout)
            tasks.append(torch_step(model, theirs, labels, torch.nn.functional.cross_entropy))
    return tasks


def dense_epochs() -> list[Task]:
    x, y = digits(60_000)
    network = dense_network()
    tasks: list[Task] = [lambda: network.train(x, y, epochs=1, batch_size=500, learning_rate=RATE)]
    if torch is not None:
        model, cost = torch_dense(), torch.nn.functional.mse_loss
        batches = zip(torch.from_numpy(x).split(500), torch.from_numpy(y).split(500), strict=True)
        steps = [torch_step(model, images, targets, cost) for images, targets in batches]
        tasks.append(lambda: [step() for step in steps])
    return tasks


def torch_step(
    model: "torch.nn.Module", images: "torch.Tensor", targets: "torch.Tensor", cost: Callable[..., "torch.Tensor"]
) -> Task:
    optimizer = torch.optim.SGD(model.parameters(), RATE)

    def step() -> None:
        optimizer.zero_grad()
        cost(model(images), targets).backward()
        optimizer.step()

    return step


def guesses() -> list[Task]:
    image = digits(1)[0].reshape(28, 28, 1)
    network = convolutional_network()
    tasks: list[Task] = [lambda: network.predict(image)]
    if torch is not None:
        for layout in (torch.contiguous_format, torch.channels_last):
            model = torch_convolutional(layout)
            theirs = torch.from_numpy(image).reshape(1, 1, 28, 28).to(memory_format=layout)
            tasks.append(torch.no_grad()(lambda model=model, theirs=theirs: model(theirs)))
    return tasks


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    versions = f"Python {platform.python_version()}, NumPy {np.__version__}"
    if torch is not None:
        torch.set_num_threads(1)
        versions += f", PyTorch {torch.__version__}"
    print(f"{versions}, one thread; medians in ms\n")
    print(f"{'':44}{'ours':>8}{'PyTorch':>10}{'ratio':>8}{'ch. last':>10}{'ratio':>8}")
    for name, tasks, calls, rounds in (
        (f"convolutions, step of {BATCH}", convolution_steps(), 1, 60),
        ("convolutions, guess of one image", guesses(), 50, 20),
        ("784-100-50-10 tanh, epoch of 60,000", dense_epochs(), 1, 12),
    ):
        ours, *theirs = (microseconds / 1000 for microseconds in medians(*tasks, calls=calls, rounds=rounds))
        print(f"{name:44}{ours:8.2f}" + "".join(f"{time:10.2f}{ours / time:8.2f}" for time in theirs))
    if torch is None:
        print('\nPyTorch is not installed; to compare with it: pip install -e ".[bench]"')


if __name__ == "__main__":
    main()
