"""Mirror symmetry of an environment, as data augmentation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ai.agent.replay import Transition
from ai.environment import Floats, Ints


@dataclass(frozen=True)
class Symmetry:
    """Mirror symmetry of an environment: a transition's mirror image is a transition that could have been, too.

    Feature i of a mirrored state is signs[i] · state[features[i]]; the mirror image of action a is actions[a].
    """

    signs: Floats  # (features,) to multiply a state by
    features: Ints  # (features,) which feature stands in each place
    actions: Ints  # (actions,) which action each becomes

    @cached_property
    def matrix(self) -> Floats:
        """Matrix that mirrors a state, (features, features): exact, since all but one term of a sum are 0."""
        size = len(self.features)
        matrix = np.zeros((size, size), dtype=np.float32)
        matrix[self.features, np.arange(size)] = self.signs
        return matrix

    def apply(self, transitions: Transition, batch_size: int, count: int) -> Transition:
        """Return minibatches, one after another (batches · batch_size), with the first `count` of each mirrored.

        All arrays are new. States are in the units of the environment: scaled by different means for left and right,
        they have no mirror image of this form.
        """
        state, next_state = transitions.state.copy(), transitions.next_state.copy()
        action = transitions.action.copy()
        for states in (state, next_state):
            batches = states.reshape(-1, batch_size, states.shape[-1])
            batches[:, :count] = batches[:, :count] @ self.matrix
        batches = action.reshape(-1, batch_size)
        batches[:, :count] = self.actions[batches[:, :count]]
        return transitions._replace(state=state, next_state=next_state, action=action)
