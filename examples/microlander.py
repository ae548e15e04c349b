"""The whole thing in one file: a lander on the moon, and a neural network that learns from nothing to land it.

Read it from top to bottom: the moon, the network, and how the network learns to fly. NumPy multiplies arrays; all else
is here. Above each part stands the module that is its grown-up. Run it: `python examples/microlander.py --seed 1`.
"""

import argparse
import os
import time

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # one core: these matrices are too small to share
import numpy as np

# 1. The moon and the craft, in metres, seconds and radians. Grown up: ai/lander/rules.py
GRAVITY = 1.62
MAIN_THRUST = 4.2  # newtons, from below; the craft has one kilogram
SIDE_THRUST = 0.9  # newtons, from a jet on one side
JET_HEIGHT = 0.7  # of the jets above the centre of mass: so they turn the craft as well
INERTIA = 0.5
CORNERS = np.array([[-0.85, 0.85, -0.42, 0.42], [-0.96, -0.96, 0.75, 0.75]])  # two feet, two ends of the roof
PAD = 3.0  # from its middle, at x = 0, to each end; the ground is at y = 0
MAIN = np.array([0, 0, 0, 1, 1, 1])  # which of the six actions fire the main engine
SIDE = np.array([0, -1, 1, 0, -1, 1])  # and which push to the left or to the right
DT = 1 / 15  # seconds of a step: an action is held for so long
LONGEST = 375  # steps of a flight


# 2. Where flights begin. Grown up: ai/lander/spawns.py
def begin(rng, count, anywhere=False):
    """Return so many starts: in training most are close above the pad, in the exam they are anywhere, and tumbling."""
    hardness = np.ones(count) if anywhere else 1.2 * rng.random(count) ** 1.4

    def spread(reach):
        return hardness * rng.uniform(-reach, reach, count)

    height = 3.0 + 11.5 * hardness + spread(5.5)
    # A state: rows for x, y, vx, vy, angle and spin, and a column for each lander. All fly at once.
    return np.array([spread(15.0), height, spread(3.0), spread(2.0) - 1.0, spread(0.6), spread(0.5)])


# 3. Physics of a rigid body. Grown up: engine/integrate.py
def fly(state, action):
    """Return the state one step later."""
    x, y, vx, vy, angle, spin = state
    main = MAIN_THRUST * MAIN[action]
    side = SIDE_THRUST * SIDE[action]
    push_x = side * np.cos(angle) - main * np.sin(angle)
    push_y = side * np.sin(angle) + main * np.cos(angle)
    vx = vx + push_x * DT
    vy = vy + (push_y - GRAVITY) * DT
    spin = spin - side * JET_HEIGHT / INERTIA * DT
    # Semi-implicit Euler: velocities came first, and the new ones move the craft.
    return np.array([x + vx * DT, y + vy * DT, vx, vy, angle + spin * DT, spin])


# 4. The touch. Grown up: ai/lander/judging.py
def judge(state, strictness=1.0):
    """Return which landers have landed, and which are lost: crashed, or gone from the area."""
    x, y, vx, vy, angle, spin = state
    corners = np.outer(np.sin(angle), CORNERS[0]) + np.outer(np.cos(angle), CORNERS[1])
    touches = y + corners.min(axis=1) <= 0
    slow = np.hypot(vx, vy) < 2.0 * strictness
    upright = (np.abs(angle) < 0.35 * strictness) & (np.abs(spin) < 0.8 * strictness)
    on_pad = np.abs(x) < PAD - 0.85
    landed = touches & slow & upright & on_pad
    gone = (np.abs(x) > 22.0) | (y > 26.0)
    return landed, (touches | gone) & ~landed


# 5. Reward. Grown up: ai/lander/rewards.py
def potential(state):
    """Return how promising a state is: more so near the pad, slow and upright."""
    x, y, vx, vy, angle, _ = state
    return -0.05 * np.hypot(x, y) - 0.1 * np.hypot(vx, vy) - 0.3 * np.abs(angle)


def reward(before, after, landed, lost):
    """Return what a step earns: its gain in potential, less a little for the time, and a point for the ending."""
    return potential(after) - potential(before) - 0.003 + 1.0 * landed - 1.0 * lost


# 6. What the network observes. Grown up: ai/lander/sensing.py
def observe(state):
    """Return a row of seven numbers for each lander, none much larger than 1 near the pad."""
    x, y, vx, vy, angle, spin = state
    columns = [0.3 * x, 0.3 * y, 0.5 * vx, 0.5 * vy, np.sin(angle), np.cos(angle), spin]
    return np.stack(columns, axis=1).astype(np.float32)


# 7. The network: from an observation to the value of each action. Grown up: ai/nn/layers.py
class Network:
    """Three layers of weighted sums. The first two normalise their sums, and make 0 of what is below (ReLU)."""

    def __init__(self, rng, dtype=np.float32):
        shapes = [(7, 64), (64, 64), (64, 6)]
        self.weights = [rng.normal(0.0, np.sqrt(2 / shape[0]), shape).astype(dtype) for shape in shapes]
        self.weights[2] *= 0.1  # at first, all values are near 0
        self.biases = [np.zeros(shape[1], dtype) for shape in shapes]
        self.parameters = self.weights + self.biases
        self.means = [np.zeros_like(each) for each in self.parameters]
        self.squares = [np.zeros_like(each) for each in self.parameters]
        self.steps = 0

    def forward(self, batch):
        """Return the value of every action, (landers, 6): the rewards to come if that is done now. Keep each layer."""
        self.inputs, self.normal, self.deviation = [], [], []
        for layer in range(3):
            self.inputs.append(batch)
            batch = batch @ self.weights[layer] + self.biases[layer]
            if layer < 2:
                batch = batch - batch.mean(axis=1, keepdims=True)
                deviation = np.sqrt((batch**2).mean(axis=1, keepdims=True) + 1e-5)
                self.normal.append(batch / deviation)
                self.deviation.append(deviation)
                batch = np.maximum(self.normal[layer], 0)
        return batch

    # 8. Backpropagation. Grown up: ai/nn/network.py
    def backward(self, error):
        """Return the gradient of the cost in every parameter, by the chain rule, from that in each output, `error`."""
        of_weights, of_biases = [], []
        for layer in (2, 1, 0):
            if layer < 2:
                normal = self.normal[layer]
                error = error * (normal > 0)  # what was made 0 had no effect
                stretch = (error * normal).mean(axis=1, keepdims=True)
                error = error - error.mean(axis=1, keepdims=True) - stretch * normal  # nor has what is normalised away
                error = error / self.deviation[layer]
            of_weights.insert(0, self.inputs[layer].T @ error)
            of_biases.insert(0, error.sum(axis=0))
            error = error @ self.weights[layer].T
        return of_weights + of_biases

    # 9. From gradients to better parameters: Adam (Kingma and Ba 2015). Grown up: ai/nn/optimizers.py
    def step(self, gradients, rate):
        """Take a small step down the mean gradient, measured by how large gradients usually are."""
        self.steps += 1
        correction = np.sqrt(1 - 0.999**self.steps) / (1 - 0.9**self.steps)  # both means began at 0
        for each, gradient, mean, square in zip(self.parameters, gradients, self.means, self.squares, strict=True):
            mean[:] = 0.9 * mean + 0.1 * gradient
            square[:] = 0.999 * square + 0.001 * gradient**2
            each[:] -= rate * correction * mean / (np.sqrt(square) + 1e-7)


# 10. Replay memory: a row for each step, a column for each lander, like a film. Grown up: ai/agent/replay.py
MOMENT = np.dtype([("observation", np.float32, 7), ("action", int), ("reward", np.float32), ("over", bool)])


# 11. Deep Q-learning (Mnih et al. 2015). Grown up: ai/agent/agent.py
BATCH = 128
AHEAD = 8  # rewards of so many steps are looked up in the memory; the network guesses what comes after them
DISCOUNT = 0.985  # a reward one step later counts so much


def choose(network, observation, epsilon, rng):
    """Return the action of the greatest value for each lander, or with chance `epsilon` a random one."""
    action = network.forward(observation).argmax(axis=1)
    random = rng.random(len(action)) < epsilon
    chances = [0.23, 0.23, 0.23, 0.10, 0.10, 0.11]  # a main engine fired half the time would only hover
    action[random] = rng.choice(6, random.sum(), p=chances)
    return action


def learn(network, target, memory, rate, rng):
    """Draw moments from the memory, and move the values of what was done closer to what came of it."""
    step = rng.integers(len(memory) - AHEAD, size=BATCH)
    lander = rng.integers(memory.shape[1], size=BATCH)
    goal, discount = np.zeros(BATCH), np.ones(BATCH)
    for later in range(AHEAD):
        goal += discount * memory["reward"][step + later, lander]
        discount *= DISCOUNT * ~memory["over"][step + later, lander]  # 0 once the flight is over
    goal += discount * target.forward(memory["observation"][step + AHEAD, lander]).max(axis=1)
    values = network.forward(memory["observation"][step, lander])
    done = np.arange(BATCH), memory["action"][step, lander]
    error = np.zeros_like(values)
    error[done] = (values[done] - goal).clip(-1, 1) / BATCH  # of Huber's cost: squared, but straight beyond 1
    network.step(network.backward(error), rate)
    for slow, fast in zip(target.parameters, network.parameters, strict=True):
        slow[:] += 0.01 * (fast - slow)


# 12. Training. Grown up: ai/training/loop.py
def train(seed, steps=3600, landers=256, tell=print):
    """Return a network that has learned from nothing, in so many steps of so many landers."""
    rng = np.random.default_rng(seed)
    network = Network(rng)
    target = Network(rng)  # it follows the other slowly: goals that ran away with every step could not be reached
    memory = np.zeros((steps, landers), MOMENT)
    state = begin(rng, landers)
    age = np.zeros(landers, int)
    endings, told = [], time.process_time()
    for step in range(steps):
        left = 1 - step / steps
        epsilon = max(0.05, 3.0 * left - 2.0) ** np.linspace(1.0, 0.3, landers)  # the last landers dare the most
        now = memory[step]
        now["observation"] = observe(state)
        now["action"] = choose(network, now["observation"], epsilon, rng)
        before, state = state, fly(state, now["action"])
        landed, lost = judge(state, strictness=0.7)  # what is learned with a margin holds when it counts
        now["reward"] = reward(before, state, landed, lost)
        age += 1
        now["over"] = landed | lost | (age == LONGEST)
        endings = (endings + landed[now["over"]].tolist())[-500:]
        state[:, now["over"]] = begin(rng, now["over"].sum())
        age[now["over"]] = 0
        for _ in range(8 if step > AHEAD else 0):
            learn(network, target, memory[:step], 0.002 * left, rng)
        if endings and time.process_time() > told + 1:
            told = time.process_time()
            tell(f"{(step + 1) * landers:7,} decisions, landed {np.mean(endings):4.0%} of the last {len(endings)}")
    return target


# 13. The exam. Grown up: ai/cli/evaluate.py
def examine(network, state):
    """Return which starts the network lands from."""
    landed, lost = judge(state)
    for _ in range(LONGEST):
        state = fly(state, network.forward(observe(state)).argmax(axis=1))
        lands, loses = judge(state)
        landed |= lands & ~lost
        lost |= loses & ~landed
    return landed


# 14. One flight in the terminal. Grown up: game/scenes/watch/scene.py
def show(network, state):
    """Fly from one start, down the terminal: a line every fifth of a second, a metre to each sign."""
    for step in range(LONGEST):
        landed, lost = judge(state)
        if step % 3 == 0 or landed or lost:
            x, y, _, vy, _, _ = state[:, 0]
            print(f"{y:5.1f} m {vy:+5.1f} m/s", " " * round(22 + x) + ("X" if lost else "A"))
            time.sleep(3 * DT * os.isatty(1))
        if landed or lost:
            break
        state = fly(state, network.forward(observe(state)).argmax(axis=1))
    print(" " * 37 + "=======")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Learn to land on the moon, from nothing.")
    parser.add_argument("--seed", type=int, default=1)
    seed = parser.parse_args().seed
    network = train(seed)
    seconds = time.process_time()
    rng = np.random.default_rng([seed, 1])  # starts that it has never seen
    show(network, begin(rng, 1, anywhere=True))
    share = examine(network, begin(rng, 1000, anywhere=True)).mean()
    print(f"landed {100 * share:.1f} % of 1,000 unseen starts after {seconds:.0f} s")
