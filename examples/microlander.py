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
def begin(rng, share):
    """Return a start for each share: at 0 just above the pad, at 1 anywhere, and falling, leaning, turning.

    A state has six rows, x, y, vx, vy, angle, spin, and a column for each lander: all fly at once.
    """

    def spread(reach):
        return share * rng.uniform(-reach, reach, len(share))

    height = 3.0 + 11.5 * share + spread(5.5)
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


# 5. Pay. Grown up: ai/lander/rewards.py
def promise(state):
    """Return how promising a state is: more of it near the pad, slow and upright."""
    x, y, vx, vy, angle, _ = state
    return -0.05 * np.hypot(x, y) - 0.1 * np.hypot(vx, vy) - 0.3 * np.abs(angle)


def pay(before, after, landed, lost):
    """Return what a step earns: its gain in promise, less a little for the time, and a point won or lost at the end."""
    return promise(after) - promise(before) - 0.003 + 1.0 * landed - 1.0 * lost


# 6. What the network sees. Grown up: ai/lander/sensing.py
def see(state):
    """Return a row of seven numbers for each lander, none much larger than 1 near the pad."""
    x, y, vx, vy, angle, spin = state
    columns = [0.3 * x, 0.3 * y, 0.5 * vx, 0.5 * vy, np.sin(angle), np.cos(angle), spin]
    return np.stack(columns, axis=1).astype(np.float32)


# 7. The network, from what is seen to what each action is worth. Grown up: ai/nn/layers.py
class Network:
    """Three layers of weighted sums. After the first two, sums are normalised, and those below 0 become 0."""

    def __init__(self, rng, dtype=np.float32):
        shapes = [(7, 64), (64, 64), (64, 6)]
        self.weights = [rng.normal(0.0, np.sqrt(2 / shape[0]), shape).astype(dtype) for shape in shapes]
        self.weights[2] *= 0.1  # at first, nothing is worth much
        self.biases = [np.zeros(shape[1], dtype) for shape in shapes]
        self.parameters = self.weights + self.biases
        self.means = [np.zeros_like(values) for values in self.parameters]
        self.squares = [np.zeros_like(values) for values in self.parameters]
        self.steps = 0

    def forward(self, values):
        """Return the worth of every action, (landers, 6); keep what the way back needs."""
        self.inputs, self.normal, self.deviation = [], [], []
        for layer in range(3):
            self.inputs.append(values)
            values = values @ self.weights[layer] + self.biases[layer]
            if layer < 2:
                values = values - values.mean(axis=1, keepdims=True)
                deviation = np.sqrt((values**2).mean(axis=1, keepdims=True) + 1e-5)
                values = values / deviation
                self.normal.append(values)
                self.deviation.append(deviation)
                values = np.maximum(values, 0)
        return values

    # 8. The way back. Grown up: ai/nn/network.py
    def backward(self, slope):
        """Return the slope of the cost along every parameter, by the chain rule, given that along each output."""
        of_weights, of_biases = [], []
        for layer in (2, 1, 0):
            if layer < 2:
                normal = self.normal[layer]
                slope = slope * (normal > 0)
                along = (slope * normal).mean(axis=1, keepdims=True)
                slope = slope - slope.mean(axis=1, keepdims=True) - along * normal
                slope = slope / self.deviation[layer]
            of_weights.insert(0, self.inputs[layer].T @ slope)
            of_biases.insert(0, slope.sum(axis=0))
            slope = slope @ self.weights[layer].T
        return of_weights + of_biases

    # 9. From slopes to better parameters: Adam (Kingma and Ba 2015). Grown up: ai/nn/optimizers.py
    def step(self, slopes, rate):
        """Take a small step down the mean slope, measured by how large slopes usually are."""
        self.steps += 1
        young = np.sqrt(1 - 0.999**self.steps) / (1 - 0.9**self.steps)  # both means began at 0
        for values, slope, mean, square in zip(self.parameters, slopes, self.means, self.squares, strict=True):
            mean[:] = 0.9 * mean + 0.1 * slope
            square[:] = 0.999 * square + 0.001 * slope**2
            values[:] -= rate * young * mean / (np.sqrt(square) + 1e-7)


# 10. The memory, a film with a row for each step and a column for each lander. Grown up: ai/agent/replay.py
MOMENT = np.dtype([("seen", np.float32, 7), ("action", int), ("pay", np.float32), ("over", bool)])


# 11. Deep Q-learning (Mnih et al. 2015). Grown up: ai/agent/agent.py
BATCH = 128
AHEAD = 8  # steps that are looked up in the film; what comes after them is guessed by the network
DISCOUNT = 0.985  # what is earned a step later counts so much


def choose(network, seen, daring, rng):
    """Return the action worth most for each lander, or with a chance of `daring` a random one (ε-greedy)."""
    action = network.forward(seen).argmax(axis=1)
    dares = rng.random(len(action)) < daring
    chances = [0.23, 0.23, 0.23, 0.10, 0.10, 0.11]  # a main engine fired half the time would only hover
    action[dares] = rng.choice(6, dares.sum(), p=chances)
    return action


def learn(network, steady, film, rate, rng):
    """Draw moments from the film, and bring the worth of what was done there closer to what came of it."""
    step = rng.integers(len(film) - AHEAD, size=BATCH)
    lander = rng.integers(film.shape[1], size=BATCH)
    goal, counts = np.zeros(BATCH), np.ones(BATCH)
    for later in range(AHEAD):
        goal += counts * film["pay"][step + later, lander]
        counts *= DISCOUNT * ~film["over"][step + later, lander]  # 0 once the flight is over
    goal += counts * steady.forward(film["seen"][step + AHEAD, lander]).max(axis=1)
    worth = network.forward(film["seen"][step, lander])
    done = np.arange(BATCH), film["action"][step, lander]
    slope = np.zeros_like(worth)
    slope[done] = (worth[done] - goal).clip(-1, 1) / BATCH  # of the squared error, and straight beyond 1 (Huber)
    network.step(network.backward(slope), rate)
    for slow, fast in zip(steady.parameters, network.parameters, strict=True):
        slow[:] += 0.01 * (fast - slow)


# 12. Training. Grown up: ai/training/loop.py
def train(seed, steps=3600, landers=256, tell=print):
    """Return a network that has learned from nothing, in so many steps of so many landers."""
    rng = np.random.default_rng(seed)
    network, steady = Network(rng), Network(rng)  # the second follows the first slowly, and is the better judge
    film = np.zeros((steps, landers), MOMENT)
    state, age = begin(rng, 1.2 * rng.random(landers) ** 1.4), np.zeros(landers, int)
    endings, told = [], time.process_time()
    for step in range(steps):
        now, left = film[step], 1 - step / steps
        daring = max(0.05, 3.0 * left - 2.0) ** np.linspace(1.0, 0.3, landers)  # some go on daring more than others
        now["seen"] = see(state)
        now["action"] = choose(network, now["seen"], daring, rng)
        before, state = state, fly(state, now["action"])
        landed, lost = judge(state, strictness=0.7)  # what is learned with a margin holds when it counts
        age += 1
        now["over"] = over = landed | lost | (age == LONGEST)
        now["pay"] = pay(before, state, landed, lost)
        state[:, over] = begin(rng, 1.2 * rng.random(over.sum()) ** 1.4)
        age[over] = 0
        endings = (endings + landed[over].tolist())[-500:]
        for _ in range(8 if step > AHEAD else 0):
            learn(network, steady, film[:step], 0.002 * left, rng)
        if endings and time.process_time() > told + 1:
            told = time.process_time()
            tell(f"{(step + 1) * landers:7,} decisions, landed {np.mean(endings):4.0%} of the last {len(endings)}")
    return steady


# 13. The exam. Grown up: ai/cli/evaluate.py
def examine(network, state):
    """Return which starts the network lands from."""
    landed, lost = judge(state)
    for _ in range(LONGEST):
        state = fly(state, network.forward(see(state)).argmax(axis=1))
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
        state = fly(state, network.forward(see(state)).argmax(axis=1))
    print(" " * 35 + "=======")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Learn to land on the moon, from nothing.")
    parser.add_argument("--seed", type=int, default=1)
    seed = parser.parse_args().seed
    network = train(seed)
    seconds = time.process_time()
    rng = np.random.default_rng([seed, 1])  # starts that it has never seen
    show(network, begin(rng, np.ones(1)))
    share = examine(network, begin(rng, np.ones(1000))).mean()
    print(f"landed {100 * share:.1f} % of 1,000 unseen starts after {seconds:.0f} s")
