"""Reading handwritten digits: the network, MNIST, preprocessing, and how a reader is taught."""

from ai.digits.classifier import DigitClassifier
from ai.digits.mnist import MnistError, load_mnist
from ai.digits.preprocessing import preprocess

__all__ = ["DigitClassifier", "MnistError", "load_mnist", "preprocess"]
