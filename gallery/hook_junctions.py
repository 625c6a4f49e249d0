"""Pull of a horseshoe's chain of seams left and right of its junctions, per mm of seam.

Prints for every junction the mean of two vertices on each side: the whole pull, and the part of it
across the wire; and how far rings have slid.

    python gallery/hook_junctions.py [element size in mm]
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import seatlook
from seatlook import mesh
from seatlook.seats import write_demo

with tempfile.TemporaryDirectory() as folder:
    write_demo(Path(folder), shape="horseshoe")
    scene = seatlook.load_scene(Path(folder) / "scene.toml")
size = 1e-3 * float(sys.argv[1]) if len(sys.argv) > 1 else None
solution = seatlook.solve(seatlook.assemble(scene, element_size=size))
(hook,) = (h for h in scene.hooks if h.chain)
(anchor,) = (a for a in solution.cover.anchors if a.name == hook.name)

print(f"{solution.status}; {len(hook.chain)} seams under the wire {hook.wire!r}")
near = {seam.name: seam.a for seam in scene.pattern.seams}
ends = np.cumsum([scene.pattern.edge_length(near[line]) for line in hook.chain])
force = solution.forces[hook.name] / anchor.length[:, None] / 1e3
place = anchor.wire.nearest(anchor.points.at(solution.positions))
direction = mesh.directions_at(anchor.wire.curve, place)
along = (force * direction).sum(axis=1, keepdims=True) * direction
across = force - along
print("junction_mm  pull_left  pull_right  ratio  across_left  across_right  ratio   [N/mm]")
for end in ends[:-1]:
    k = int(np.abs(anchor.at - end).argmin())
    row = [1e3 * end]
    for part in (force, across):
        size = np.linalg.norm(part, axis=1)
        left, right = size[k - 2 : k].mean(), size[k + 1 : k + 3].mean()
        row += [left, right, left / right]
    print("{:11.1f}  {:9.3f}  {:10.3f}  {:5.2f}  {:11.3f}  {:12.3f}  {:5.2f}".format(*row))
total = [1e3 * (np.linalg.norm(part, axis=1) @ anchor.length) for part in (along, across)]
slid = 1e3 * (place - anchor.wire.place)
print(
    f"in all {total[0]:.2f} N along the wire, {total[1]:.1f} N across it; slid by "
    f"{slid.min():.2f} to {slid.max():.2f} mm, in order: {bool((np.diff(place) > 0.0).all())}"
)
