"""The robot that is given commands, as an environment of Gymnasium: `gymnasium.make("dcg_torch/Ground-v0")`.

Importing this module registers it. `env` holds the environment, `scenario` its settings and spaces, `agents` example
agents; only `agents` needs torch.
"""

from __future__ import annotations

import gymnasium

ID = "dcg_torch/Ground-v0"
MOST_STEPS = 64
"""After which an episode is cut off: three times what the paper's policy needs at the most."""

if ID not in gymnasium.registry:
    gymnasium.register(ID, entry_point="dcg_torch.apps.gym.env:GroundEnv", max_episode_steps=MOST_STEPS)
