#!/usr/bin/python3
"""A task for reinforcement learners, with the calls of gymnasium and without needing it.

The hand leads the tip; what is asked for is a steady force on the table while it slides along.

    env = TouchEnv(force=0.5)
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(action)

Observation: device's tip and the hardest contact [m] (zeros: none), force on the proxy [N]; nine numbers. Action: how far the
hand's target moves within a step of 10 ms, x, y, z [m], at most 1 mm each. Reward: 0 at the wanted force
and speed, less than that otherwise.
"""

import numpy

import limpid

STEP = 10  # ticks
FARTHEST = 1e-3  # [m] a step
SPEED = 0.02  # along y, wanted [m/s]


class TouchEnv:
    def __init__(self, force: float = 0.5, seconds: float = 5.0, **settings) -> None:
        """`settings` are those of limpid.Loop: coupling="predictive", eta=0.5, scene=..., arm=..."""
        self.loop = limpid.Loop(**{"coupling": "predictive", **settings})
        self.home = numpy.array(self.loop.tip)
        self.force, self.steps = force, round(seconds / (STEP * self.loop.period))

    def reset(self, seed=None, options=None):
        chance = numpy.random.default_rng(seed)
        self.target = self.home + chance.uniform(-0.01, 0.01, 3)
        self.loop.start(self.target)
        self.taken = 0
        return self._observed(self.loop.step(self.target)), {}

    def step(self, action):
        before = self.target.copy()
        self.target += numpy.clip(action, -FARTHEST, FARTHEST)
        for k in range(STEP):
            row = self.loop.step(before + (k + 1) / STEP * (self.target - before))
        self.taken += 1
        seen = self._observed(row)
        pressed, moved = seen[8], (self.target - before)[1] / (STEP * self.loop.period)
        reward = -abs(pressed - self.force) - 10 * abs(moved - SPEED)
        return seen, float(reward), self.loop.diverged, self.taken >= self.steps, {"energy": self.loop.energy}

    def _observed(self, row):
        force = row["contact/force"].sum(axis=0)
        return numpy.concatenate([self.loop.tip, numpy.nan_to_num(row["contact/point"][0]), force])


def press(env: TouchEnv):
    """A hand that presses until it feels the force, and slides on."""
    seen, _ = env.reset(seed=1)
    total, done = 0.0, False
    while not done:
        down = 2e-4 * (env.force - seen[8])
        seen, reward, terminated, truncated, _ = env.step([0, 2e-4, -down])
        total, done = total + reward, terminated or truncated
    return total, seen[8]


if __name__ == "__main__":
    reward, force = press(TouchEnv())
    print(f"reward {reward:.1f}, at last {force:.2f} N")
