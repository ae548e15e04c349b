"""Training of a digit network, its evaluation, and its run on disk."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final, Self

import numpy as np
import numpy.typing as npt

from ai.digits.augmentation import Strength, augment
from ai.digits.classifier import KIND, DigitClassifier
from ai.digits.config import DIGIT_PRESETS, DigitConfig, build_digit_network
from ai.digits.handwriting import drawings
from ai.digits.mnist import TEST, TRAIN, Images, Labels, load_part
from ai.files.reading import array_like, inside, number_of, read_json
from ai.files.schema import Count, Duration, OneOf, Seed, Share, read_as
from ai.nn import OPTIMIZERS, Array
from ai.nn.storage import reading
from ai.run import TRAINING_FILE, Measured, Run

SPLIT_SEED: Final = 28  # which images are held out does not depend on the run
_OPTIMIZER: Final = "optimizer."  # begins the names of what the optimizer remembers, in a state


@dataclass(frozen=True)
class DigitProgress(Measured):
    """Progress of a run after one learning step."""

    step: int  # learning steps so far
    epoch: float  # how often every image has been seen
    loss: float  # of the last batch
    accuracy: float  # of the last batch, share read right as it was learnt from: augmented, and with dropout
    learning_rate: float
    images_per_second: float


class DigitTraining(Run):
    """Digit training run: all state that changes as it goes on. `data` are images and labels in place of MNIST's.

    Attributes:
        step: learning steps so far.
        best: the highest accuracy on the images held out; `best_values` are the weights that had it.
        history: an entry for each epoch.

    """

    kind, needs_state = KIND, True
    config: DigitConfig

    def __init__(self, config: DigitConfig, seed: int = 0, data: tuple[Images, Labels] | None = None) -> None:
        super().__init__(config, seed)
        self.config, self.step = config, 0
        self.best: float | None = None
        self.best_values: Array | None = None
        self.history: list[dict[str, Any]] = []
        images, labels = data or load_part(TRAIN)
        order = np.random.default_rng(SPLIT_SEED).permutation(len(images))
        kept, held = np.split(order, [len(images) - config.held_out])
        if not len(kept):
            raise ValueError(f"held_out leaves none of {len(images)} images to learn from")
        self.images, self.labels = images[kept], labels[kept]
        self.held_images, self.held_labels = images[held], labels[held]
        network = build_digit_network(config, np.random.default_rng(seed))
        self.classifier = DigitClassifier(network)
        self.optimizer = OPTIMIZERS[config.optimizer](config.learning_rate)
        self.average = network.values.astype(np.float32, copy=True)
        self._loss = self._accuracy = 0.0
        self._batch = np.nan, np.nan, np.nan, np.nan  # loss, accuracy, learning rate and pace of the last one
        self._order = np.empty(0, np.intp)

    @property
    def steps_per_epoch(self) -> int:
        """Number of batches in an epoch, which sees every image once; the last may be smaller."""
        return math.ceil(len(self.images) / self.config.batch_size)

    @property
    def steps(self) -> int:
        return self.config.epochs * self.steps_per_epoch

    @property
    def moment(self) -> int:
        return self.step

    @property
    def learning_rate(self) -> float:
        """Learning rate: it rises in a straight line, then falls along half a cosine (Loshchilov & Hutter 2017)."""
        config, warm = self.config, self.config.warm_up_epochs * self.steps_per_epoch
        rise = min(1.0, (self.step + 1) / warm) if warm else 1.0
        share = min(1.0, self.step / self.steps)
        fall = 0.5 + 0.5 * math.cos(math.pi * share)
        return rise * (config.final_learning_rate + (config.learning_rate - config.final_learning_rate) * fall)

    def apply_live(self, config: DigitConfig) -> None:
        self.config = self.config.with_live(config)

    def take_step(self) -> None:
        """Learn from one batch, and measure what is held out if an epoch ends with it."""
        began, config, network = self.clock(), self.config, self.classifier.network
        epoch, place = divmod(self.step, self.steps_per_epoch)
        # Each step has a generator of its own, so a run that is resumed goes on as if it had never stopped.
        if place == 0 or not len(self._order):
            self._order = np.random.default_rng((self.seed, 1, epoch)).permutation(len(self.images))
        batch = self._order[place * config.batch_size : (place + 1) * config.batch_size]
        rng = np.random.default_rng((self.seed, 2, self.step))
        labels = self.labels[batch]
        images = self._changed(self.images[batch], labels, rng)
        targets = np.full((len(batch), 10), config.label_smoothing / 10, np.float32)
        targets[np.arange(len(batch)), labels] += 1 - config.label_smoothing

        self.optimizer.learning_rate = rate = self.learning_rate
        for layer in network.layers:
            layer.rng = rng  # dropout's
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is found by the optimizer
            outputs = network.forward_propagate(self.classifier.shaped(images))
        accuracy = float((outputs.argmax(axis=1) == labels).mean())
        loss = network.correct(outputs, targets, self.optimizer)
        self.step += 1
        # A young average follows faster, so that it soon forgets the initial weights.
        keep = min(config.ema_decay, self.step / (self.step + 10))
        if keep:
            self.average += (1 - keep) * (network.values - self.average)
        else:
            self.average[...] = network.values  # exactly, as a sum of differences would not be
        self._loss += (loss - self._loss) * 0.05
        self._accuracy += (accuracy - self._accuracy) * 0.05
        spent = self.clock() - began
        self._batch = loss, accuracy, rate, len(batch) / spent if spent > 0 else 0.0
        if self.step % self.steps_per_epoch == 0:
            self._measure()

    @property
    def progress(self) -> DigitProgress:
        return DigitProgress(self.seconds, self.step, self.step / self.steps_per_epoch, *self._batch)

    def __str__(self) -> str:
        """Say how it stands."""
        best = f", held out {self.best:.2%}" if self.best is not None else ""
        return f"epoch {self.progress.epoch:.1f}, loss {self.progress.loss:.3f}{best}"

    def _changed(self, images: Images, labels: Labels, rng: np.random.Generator) -> Images:
        config, images = self.config, images.copy()
        drawn = rng.random(len(images)) < config.drawn
        if config.augmentation:
            changed = ~drawn & (rng.random(len(images)) >= config.unaugmented)
            images[changed] = augment(images[changed], rng, Strength().times(config.augmentation))
        images[drawn] = drawings(labels[drawn], rng)
        return images

    def _measure(self) -> None:
        """Measure the average on the images held out, and keep it if it is the best so far."""
        epoch = self.step // self.steps_per_epoch
        entry = {"epoch": epoch, "loss": self._loss, "accuracy": self._accuracy}
        if len(self.held_images):
            held_out = entry["held_out"] = accuracy(self.current(), self.held_images, self.held_labels)
            if self.best is None or held_out >= self.best:
                self.best, self.best_values = held_out, self.average.copy()
        self.history.append(entry)

    def current(self) -> DigitClassifier:
        """Return a classifier with the average of the weights as it is now."""
        network = self.classifier.network.copy()
        network.values = self.average
        return DigitClassifier(network)

    @property
    def best_epoch(self) -> int | None:
        """Epoch after which the network was best; None if that is the current one, or none was measured."""
        if self.best_values is None or np.array_equal(self.best_values, self.average):
            return None
        return next((int(each["epoch"]) for each in reversed(self.history) if each.get("held_out") == self.best), None)

    def restore(self, values: Array) -> None:
        """Restore the network and its average to the parameters `values` (parameters,); reset the optimizer."""
        self.classifier.network.values = values
        self.average[...] = values
        self.optimizer = OPTIMIZERS[self.config.optimizer](self.config.learning_rate)

    def restore_best(self) -> None:
        if self.best_values is not None:
            self.restore(self.best_values)

    def best_classifier(self) -> DigitClassifier:
        """Return the classifier that read the images held out best, or the current one."""
        classifier = self.current()
        if self.best_values is not None:
            classifier.network.values = self.best_values
        return classifier

    # On disk

    def snapshot(self, final: bool = False) -> tuple[dict[str, Any], Callable[[Path], None]]:
        """Return what its training file says now, and what writes its best network into a new folder.

        A `final` one is measured on MNIST's test images; raises MnistError if there are none.
        """
        best = self.best_classifier()
        epochs, seconds = self.step // self.steps_per_epoch, round(self.seconds, 3)
        described = {
            **self.config.described(DIGIT_PRESETS), "seed": self.seed, "step": self.step, "epochs": epochs,
            "seconds": seconds, "held_out": self.best, "kept_epoch": self.best_epoch, "history": [*self.history],
        }  # fmt: skip
        if final:
            described["test"] = accuracy(best, *load_part(TEST))
        return described, best.write

    @classmethod
    def begun(cls, folder: Path, *, data: tuple[Images, Labels] | None = None, **_: Any) -> Self:
        network = DigitClassifier.load(folder).network
        with reading(folder, TRAINING_FILE):
            described = read_as(DescribedRun, read_json(inside(folder, TRAINING_FILE)))
            config = DigitConfig.from_json(DIGIT_PRESETS[described.preset].to_json() | described.changes)
            run = cls(config, described.seed, data)
        run.step, run.seconds, run.history = described.step, described.seconds, list(described.history)
        run.best = described.held_out
        if run.best is not None:
            run.best_values = network.values.copy()
        return run

    def state(self) -> dict[str, Any]:
        values, means = self.classifier.network.values, {"loss": self._loss, "accuracy": self._accuracy}
        optimizer = {f"{_OPTIMIZER}{name}": part for name, part in self.optimizer.state().items()}
        return means | optimizer | {"values": values.copy(), "average": self.average.copy()}

    def load_state(self, state: dict[str, Any]) -> None:
        network = self.classifier.network
        network.values = array_like(network.values, state["values"], "values")
        self.average[...] = array_like(self.average, state["average"], "average")
        held = {name.removeprefix(_OPTIMIZER): part for name, part in state.items() if name.startswith(_OPTIMIZER)}
        self.optimizer.load_state(held, network.values)
        self._loss, self._accuracy = float(number_of(state["loss"])), float(number_of(state["accuracy"]))


def accuracy(classifier: DigitClassifier, images: Images, labels: Labels) -> float:
    """Return the share of images that are read right."""
    return float((classifier.predict(images).argmax(axis=1) == labels).mean())


def confusion(labels: npt.NDArray[Any], read: npt.NDArray[np.intp]) -> npt.NDArray[np.int64]:
    """Return how often each digit (row) was read as which (column), (10, 10), by labels and answers (n,)."""
    table = np.zeros((10, 10), np.int64)
    np.add.at(table, (labels, read), 1)
    return table


@dataclass(frozen=True)
class DescribedRun:
    """What the training file of a run says."""

    preset: Annotated[str, OneOf(DIGIT_PRESETS)]
    changes: dict[str, Any]
    seed: Seed
    step: Count
    seconds: Duration
    held_out: Share | None
    history: tuple[dict[str, Any], ...]
