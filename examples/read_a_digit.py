"""Read digits with the network that comes with the game: the first ten of MNIST's test images."""

from pathlib import Path

from ai.digits import DigitClassifier, load_mnist

MODEL = Path(__file__).parents[1] / "models" / "digits" / "modern"

if __name__ == "__main__":
    reader = DigitClassifier.load(MODEL)
    _, _, images, labels = load_mnist()
    for chances, label in zip(reader.predict(images[:10]), labels[:10], strict=True):
        print(f"drawn as {label}, read as {chances.argmax()}, {chances.max():.0%} sure")
