"""Handwritten digit recognition: classifier, MNIST, preprocessing and training."""

from ai.digits.classifier import DigitClassifier
from ai.digits.mnist import MnistError, load_mnist
from ai.digits.preprocessing import preprocess

__all__ = ["DigitClassifier", "MnistError", "load_mnist", "preprocess"]
