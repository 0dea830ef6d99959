"""Lesson 4: how stiff a wall feels. Run as it is, or cell by cell (# %%)."""

# %% The same press onto walls of several stiffnesses.
import tempfile
from pathlib import Path

from lesson import LAWS, figure, limpid, show

PRESS = [(0, 0.19, 0, 0), (0.2, 0.19, 0, 0), (0.7, 0.19, 0, -0.045), (1.2, 0.19, 0, -0.045)]
WALL = 'title = "Wall"\n[[plane]]\nname = "wall"\npoint = [0, 0, -0.04]\nnormal = [0, 0, 1]\nstiffness = {}\n'
STIFFNESSES = (100, 200, 400, 800)
folder = Path(tempfile.mkdtemp(prefix="limpid-lesson-"))


def felt(law: str, stiffness: float) -> float:
    """Force over the way of the device into the wall [N/m]."""
    scene = folder / f"{stiffness}.toml"
    scene.write_text(WALL.format(stiffness))
    session = limpid.run(scene=scene, hand=PRESS, coupling=law)
    return float(session.contact_force[-50:, 2].mean() / (-0.04 - session.device_tip[-50:, 2].mean()))


# %% The standard coupling is a spring in series with the wall.
found = {law: [felt(law, stiffness) for stiffness in STIFFNESSES] for law in LAWS}
figure("walls", "What a wall feels like", "stiffness of the wall [N/m]", "felt [N/m]",
       {law: (STIFFNESSES, values) for law, values in found.items()})
for law, values in found.items():
    print(f"{law:>10}: " + ", ".join(f"{value:.0f}" for value in values))

# %% To be felt.
show("Press onto the wall: it has 800 N/m, and feels like one of 183.", str(folder / "800.toml"),
     **{"coupling.kind": "standard"})
