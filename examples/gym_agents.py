"""Three agents in the Gymnasium environment: one that acts at random, the paper's policy, and the shipped model.

Run it with `python examples/gym_agents.py [EPISODES]`; it needs the extra `gym`.
"""

from __future__ import annotations

import sys

import gymnasium

import dcg_torch.apps.gym  # registers the environment
from dcg_torch.apps.gym.agents import Agent, open_world_settings, paper_settings
from dcg_torch.settings import Asking


def play_at_random(env: gymnasium.Env, episodes: int) -> tuple[float, float]:
    """What every environment of Gymnasium can be used with; mean reward, share right."""
    env.action_space.seed(0)
    rewards = right = 0.0
    for episode in range(episodes):
        _, info = env.reset(seed=0 if episode == 0 else None)
        over = False
        while not over:
            _, reward, terminated, truncated, info = env.step(env.action_space.sample())
            rewards += float(reward)
            over = terminated or truncated
        right += info.get("correct", False)
    return rewards / episodes, right / episodes


def play(agent: Agent, episodes: int) -> tuple[float, float]:
    """Mean reward, share right."""
    played = [agent.play(seed=0 if episode == 0 else None) for episode in range(episodes)]
    return sum(p.reward for p in played) / episodes, sum(p.info.get("correct", False) for p in played) / episodes


def main() -> None:
    """The same worlds and commands for each."""
    episodes = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    env = gymnasium.make(dcg_torch.apps.gym.ID)
    report("at random", *play_at_random(env, episodes))
    report("the paper's policy", *play(Agent(env, paper_settings()), episodes))
    report("the shipped model", *play(Agent(env, open_world_settings()), episodes))
    report("the same, asking", *play(Agent(env, open_world_settings(Asking.when_unsure)), episodes))


def report(name: str, reward: float, right: float) -> None:
    """One line."""
    print(f"{name}: reward {reward:.2f}, right {right:.0%}")


if __name__ == "__main__":
    main()
