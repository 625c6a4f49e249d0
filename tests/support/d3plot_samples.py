"""d3plot files written word by word, apart from the reader, with every part that shifts others."""

import numpy as np

END = -999999.0


def quad_strip(n=6, size=10.0):
    """Nodes (mm) and shells of a flat strip of n quadrilaterals, the last one cut in two triangles.

    Node numbers from 1; a triangle repeats its third node.
    """
    nodes = np.array([[i * size, j * size, 0.0] for i in range(n + 1) for j in range(2)])
    quads = [[2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2] for i in range(n)]
    a, b, c, d = quads.pop()
    return nodes, np.array([*quads, [a, b, c, c], [a, c, d, d]])


def d3plot(
    nodes,
    shells,
    states,
    *,
    part=None,
    word="<i4",
    thickness=True,
    strains=True,
    layers=3,
    velocity=True,
    solids=0,
    beams=0,
    globals_=8,
    deletion=None,
    rigid_part=None,
    names=None,
    ids=(11, 12),
    control=None,
    history=0,
    plastic=False,
    thermal=False,
    strain_digit=False,
    in_plane=1,
    release="",
    sph=0,
    sph_flags=(11, 1, 1, 6, 1, 1, 1, 1, -6, 1, 2),
    airbags=(),
):
    """Bytes of one file.

    ``states``: list of (time, positions, thickness (e,), inner (e, 6), outer (e, 6)).
    ``names``: number -> title. User numbers: nodes 1.., shells 101.., parts 11.. or ``ids``.
    ``sph``: nodes of smoothed particles; ``airbags``: version, bags, chambered, numbers of geometry
    and state variables, particles, state variables of a bag.
    ``history``, ``plastic``, ``thermal``: further words of a shell's row, filled with noise.
    """
    real = word.replace("i", "f")
    e, n = len(shells), len(nodes)
    part = np.ones(e, dtype=int) if part is None else np.asarray(part)
    parts = int(part.max())
    layered = in_plane * layers * (7 + history) + 8
    tensors = 18 * plastic + 6 * thermal
    width = layered + 4 * thickness + 12 * strains + tensors
    reported = np.ones(e, dtype=bool) if rigid_part is None else part != rigid_part
    head = np.zeros(64, dtype=word)
    narbs = 16 + n + solids + beams + e + 3 * parts if ids else 0
    values = {
        11: 1, 15: 3 if rigid_part is None else 5, 16: n, 17: 6, 18: globals_, 20: 1,
        21: int(velocity), 23: solids, 24: 1 if solids else 0, 27: 7, 28: beams, 30: 6,
        25: -1 if in_plane > 1 else 1, 31: e, 32: parts, 33: width, 35: history, 39: narbs,
        36: layers if deletion is None else -(10000 + layers),
        37: sph, 54: 1000 * airbags[0] + airbags[1] if airbags else 0,
        43: 1000, 44: 1000, 45: 1000, 46: 1000 if thickness else 0, 51: parts,
        56: 100 * plastic + 1000 * thermal + 10000 * strain_digit,
    }  # fmt: skip
    for at, value in (values | (control or {})).items():
        head[at] = value
    head[13:14] = np.frombuffer(release.encode().ljust(int(word[2])), dtype=word)
    out = [head]
    if rigid_part is not None:
        kinds = np.full(parts, 34)
        kinds[rigid_part - 1] = 20
        out.append(np.array([(~reported).sum(), parts, *kinds], dtype=word))
    flags, lists, particle_values = _particles(sph, sph_flags, airbags)
    out.append(np.array(flags, dtype=word))
    out.append(_floats(nodes, real, word))
    out.append(np.ones(9 * solids, dtype=word))
    out.append(np.ones(6 * beams, dtype=word))
    out.append(np.column_stack([shells, part]).astype(word).ravel())
    if ids:
        out.append(np.array([-1, *[0] * 4, n, solids, beams, e, 0, 0, 0, 0, parts, 0, parts], word))
        runs = [np.arange(1, n + 1), 1 + np.arange(solids), 1 + np.arange(beams),
                101 + np.arange(e), *[np.array(ids[:parts])] * 3]  # fmt: skip
        out += [r.astype(word) for r in runs]
    out.append(np.ones(lists, dtype=word))
    out.append(_floats([END], real, word))
    if names:
        out += _titles(names, word)
        out.append(_floats([END], real, word))
    noise = np.random.default_rng(width)
    for time, positions, t, inner, outer in states:
        rows = [noise.uniform(1, 2, (e, layered))]
        if thickness:
            rows += [np.asarray(t)[:, None], np.full((e, 2), 0.25)]
        if strains:
            rows += [inner, outer]
        if thickness:
            rows.append(np.full((e, 1), 0.5))
        rows.append(noise.uniform(1, 2, (e, tensors)))
        row = np.hstack(rows)[reported]
        pieces = [[time], np.full(globals_, 0.75), np.ravel(positions)]
        pieces += [np.full(3 * n, 0.0625)] if velocity else []
        pieces += [np.full(7 * solids + 6 * beams, 0.375), row.ravel()]
        if deletion is not None:
            pieces += [np.ones(solids), deletion, np.ones(beams)]
        pieces.append(np.full(particle_values, 0.625))
        out.append(_floats(np.concatenate([np.ravel(p) for p in pieces]), real, word))
    out.append(_floats([END], real, word))
    return b"".join(a.tobytes() for a in out)


def _particles(sph, sph_flags, airbags):
    """Flags before the nodes, words behind the rigid bodies, words of a state."""
    flags, lists, values = [], 0, 0
    if sph:
        flags += sph_flags[: sph_flags[0]]
        lists += 2 * sph
        values += sph * (1 + sum(map(abs, sph_flags[1:10])))
        values += sph * sph_flags[10] if sph_flags[0] == 11 else 0
    if airbags:
        version, bags, geometry, variables, count, bag_state = airbags
        flags += [geometry, variables, count, bag_state, *[2] * (version == 4)]
        flags += [1] * (9 * (geometry + variables + bag_state))
        lists += bags * geometry
        values += bags * bag_state + count * variables
    return flags, lists, values


def _floats(values, real, word):
    return np.asarray(values, dtype=real).ravel().view(word)


def _titles(names, word):
    out = [np.array([90001, len(names)], dtype=word)]
    for number, title in names.items():
        out.append(np.array([number], dtype=word))
        out.append(np.frombuffer(title.encode().ljust(72), dtype=word))
    return out
