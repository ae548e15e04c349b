"""Mirror symmetry of an environment, as data augmentation."""

from __future__ import annotations

from dataclasses import dataclass

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

    def mirrored(self, states: Floats) -> Floats:
        """Return the mirror images of states (..., features)."""
        mirrored: Floats = self.signs * states[..., self.features]
        return mirrored

    def apply(self, transitions: Transition, batch_size: int, count: int) -> Transition:
        """Return minibatches, one after another (batches · batch_size), with the first `count` of each mirrored.

        States and actions are new arrays. States are in the units of the environment: scaled by different means for
        left and right, they have no mirror image of this form.
        """
        state, next_state = transitions.state.copy(), transitions.next_state.copy()
        action = transitions.action.copy()
        for states in (state, next_state):
            batches = states.reshape(-1, batch_size, states.shape[-1])
            batches[:, :count] = self.mirrored(batches[:, :count])
        batches = action.reshape(-1, batch_size)
        batches[:, :count] = self.actions[batches[:, :count]]
        return transitions._replace(state=state, next_state=next_state, action=action)
