"""Learn XOR: two numbers in, one out, with a hidden layer of four units."""

import numpy as np

from ai.nn import ActivationFunctions, ActivationLayer, CostFunctions, FullyConnectedLayer, NeuralNetwork

network = (
    NeuralNetwork(*CostFunctions.use_mse(), rng=np.random.default_rng(1))
    .add_layer(FullyConnectedLayer(2, 4))
    .add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
    .add_layer(FullyConnectedLayer(4, 1))
    .add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
)
questions = np.array([[0, 0], [0, 1], [1, 0], [1, 1]], np.float32)
answers = np.array([[0], [1], [1], [0]], np.float32)

if __name__ == "__main__":
    network.train(questions, answers, epochs=2000, batch_size=4, learning_rate=0.3)
    for question, answer in zip(questions, network.predict(questions), strict=True):
        print(f"{question[0]:.0f} xor {question[1]:.0f} = {answer[0]:.2f}")
