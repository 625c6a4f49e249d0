"""Pull of a horseshoe's chain of seams left and right of its junctions, per mm of seam.

Prints for every junction the mean of two vertices on each side: the whole pull, and the part of it
across the wire.

    python gallery/hook_junctions.py
"""

import tempfile
from pathlib import Path

import numpy as np

import seatlook
from seatlook import mesh
from seatlook.seats import write_demo

with tempfile.TemporaryDirectory() as folder:
    write_demo(Path(folder), shape="horseshoe")
    seat = seatlook.open(Path(folder) / "scene.toml")
    solution = seat.solve()
    (hook,) = (h for h in seat.scene.hooks if h.chain)
    (anchor,) = (a for a in solution.cover.anchors if a.name == hook.name)

print(f"{solution.status}; {len(hook.chain)} seams under the wire {hook.wire!r}")
near = {seam.name: seam.a for seam in seat.scene.pattern.seams}
ends = np.cumsum([seat.scene.pattern.edge_length(near[line]) for line in hook.chain])
force = solution.forces[hook.name] / anchor.length[:, None] / 1e3
along = np.gradient(anchor.target, axis=0)
along /= np.linalg.norm(along, axis=1, keepdims=True)
across = force - (force * along).sum(axis=1, keepdims=True) * along
print("junction_mm  pull_left  pull_right  ratio  across_left  across_right  ratio   [N/mm]")
for end in ends[:-1]:
    k = int(np.abs(anchor.at - end).argmin())
    row = [1e3 * end]
    for part in (force, across):
        size = np.linalg.norm(part, axis=1)
        left, right = size[k - 2 : k].mean(), size[k + 1 : k + 3].mean()
        row += [left, right, left / right]
    print("{:11.1f}  {:9.3f}  {:10.3f}  {:5.2f}  {:11.3f}  {:12.3f}  {:5.2f}".format(*row))
print(
    f"length of the chain {1e3 * ends[-1]:.1f} mm, of its wire "
    f"{1e3 * mesh.length(seat.scene.foam.curves[hook.wire]):.1f} mm"
)
