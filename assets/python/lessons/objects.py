"""Lesson 5: what moves takes energy from the hand, and none comes from nowhere. Run as it is, or cell
by cell (# %%)."""

# %% A block on ice, 50 g, stands 2 cm before the tip, which pushes it forward.
import tempfile
from pathlib import Path

from lesson import LAWS, figure, limpid, show

SCENE = """title = "A block"
gravity = [0, 0, 0]
[[body]]
name = "block"
box = [0.03, 0.06, 0.06]
mass = 0.05
position = [0.19, 0, 0]
stiffness = 2000
"""
scene = Path(tempfile.mkdtemp(prefix="limpid-lesson-"), "block.toml")
scene.write_text(SCENE)
PUSH = [(0, 0.15, 0, 0), (0.2, 0.15, 0, 0), (0.5, 0.19, 0, 0), (1.0, 0.19, 0, 0)]
sessions = {law: limpid.run(scene=scene, hand=PUSH, coupling=law) for law in LAWS}

# %% The block goes on by itself: half m v^2 is what it was given.
given = {law: 1000 * s["energy/to_objects"] for law, s in sessions.items()}
figure("objects", "Energy that the block has been given", "time [s]", "energy [mJ]",
       {law: (sessions[law].time, given[law]) for law in LAWS})
for law, s in sessions.items():
    speed = float(s["objects/velocity"][-1].reshape(-1)[0])
    print(f"{law:>10}: {speed:.3f} m/s, {500 * 0.05 * speed**2:.4f} mJ moving, {given[law][-1]:.4f} mJ given, "
          f"{1000 * float(s['energy/objects_gain'].max()):.2g} mJ from nowhere")

# %% To be felt.
show("Push the block: it goes on by itself. Backspace brings it back.", str(scene), **{"coupling.kind": "predictive"})
