# SPDX-License-Identifier: BSD-3-Clause
"""The butterfly schemes in NumPy, for bench/quality: they interpolate by a local rule and never move a vertex again. Closed meshes of triangles only."""
import numpy as np
import scipy.sparse as sparse


class HalfEdges:
    """Half-edge 3 f + i runs from corner i of face f to the next one."""

    def __init__(self, faces, vertex_count):
        here = np.arange(faces.size)
        self.start, self.end = faces.ravel(), faces[:, [1, 2, 0]].ravel()
        self.after, self.before = 3 * (here // 3) + (here % 3 + 1) % 3, 3 * (here // 3) + (here % 3 + 2) % 3
        forwards, backwards = self.start * vertex_count + self.end, self.end * vertex_count + self.start
        order = np.argsort(forwards)
        self.opposite = order[np.minimum(np.searchsorted(forwards[order], backwards), len(order) - 1)]
        if not (forwards[self.opposite] == backwards).all():
            raise RuntimeError("the butterfly schemes here need a closed mesh")
        self.third = self.end[self.after]
        self.valence = np.bincount(self.start, minlength=vertex_count)


def star_weights(valence):
    """Of the neighbours of an extraordinary vertex, from the new vertex's edge on (Zorin, Schroeder, Sweldens 1996, figure 3); the vertex itself has 3/4."""
    if valence == 3:
        return np.array([5, -1, -1]) / 12
    if valence == 4:
        return np.array([3, 0, -1, 0]) / 8
    angle = 2 * np.pi * np.arange(valence) / valence
    return (0.25 + np.cos(angle) + 0.5 * np.cos(2 * angle)) / valence


def middles(mesh, edges):
    """The rules give the new vertices of half-edges as a list of (rows, columns, weights). This one leaves the polygons as they are."""
    return [(np.arange(len(edges)), ends[edges], np.full(len(edges), 0.5)) for ends in (mesh.start, mesh.end)]


def butterfly(mesh, edges):
    """Dyn, Levin, Gregory 1990, w = 1/16."""
    row, other = np.arange(len(edges)), mesh.opposite[edges]
    ends, wings = [mesh.start[edges], mesh.end[edges]], [mesh.third[edges], mesh.third[other]]
    tips = [mesh.third[mesh.opposite[side[h]]] for h in (edges, other) for side in (mesh.after, mesh.before)]
    return [(row, column, np.full(len(row), weight)) for weight, columns in ((1 / 2, ends), (1 / 8, wings), (-1 / 16, tips)) for column in columns]


def star(mesh, edges, share):
    """The rule of the extraordinary vertices at the start of half-edges, times its share."""
    row = np.flatnonzero(share)
    valence, spoke = mesh.valence[mesh.start[edges[row]]], edges[row]
    found = [(row, mesh.start[spoke], 0.75 * share[row])]
    tables = {n: star_weights(n) for n in np.unique(valence)}
    for step in range(max(tables, default=0)):
        inside = valence > step
        row, valence, spoke = row[inside], valence[inside], spoke[inside]
        found.append((row, mesh.end[spoke], np.array([tables[n][step] for n in valence]) * share[row]))
        spoke = mesh.opposite[mesh.before[spoke]]
    return found


def modified_butterfly(mesh, edges):
    """Zorin, Schroeder, Sweldens 1996: butterfly where both ends have six edges, else the rule of the end that has not, or the mean of both ends' rules."""
    is_odd = [mesh.valence[ends[edges]] != 6 for ends in (mesh.start, mesh.end)]
    shares = [odd / np.maximum(is_odd[0].astype(int) + is_odd[1], 1) for odd in is_odd]
    is_regular = ~(is_odd[0] | is_odd[1])
    regular = [(row, column, weight * is_regular) for row, column, weight in butterfly(mesh, edges)]
    return regular + star(mesh, edges, shares[0]) + star(mesh, mesh.opposite[edges], shares[1])


def step(points, faces, rule):
    """Every triangle becomes four; old vertices keep their numbers and places."""
    mesh = HalfEdges(faces, len(points))
    edges = np.flatnonzero(np.arange(faces.size) < mesh.opposite)
    row, column, weight = (np.concatenate(part) for part in zip(*rule(mesh, edges)))
    middle = np.empty(faces.size, np.int64)
    middle[edges] = middle[mesh.opposite[edges]] = len(points) + np.arange(len(edges))
    (a, b, c), (ab, bc, ca) = faces.T, middle.reshape(-1, 3).T
    fine = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    return np.concatenate([points, sparse.csr_matrix((weight, (row, column)), (len(edges), len(points))) @ points]), fine


def refine(points, faces, levels, rule):
    for _ in range(levels):
        points, faces = step(points, faces, rule)
    return points, faces
