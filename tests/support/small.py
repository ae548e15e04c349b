"""Networks so small that tests can train them for a moment."""

from ai.digits.config import DIGIT_PRESETS
from ai.training.config import PRESETS

LANDERS = PRESETS["modern"].changed(
    num_envs=4, hidden=(8,), learning_starts=64, replay_size=1000, batch_size=16, gradient_steps=1
)
DIGITS = DIGIT_PRESETS["classic"].changed(hidden=(8,), held_out=2_000, batch_size=20, augmentation=0.0)
