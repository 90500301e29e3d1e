# SPDX-License-Identifier: BSD-3-Clause
"""What bench/quality measures: how near a filtered mesh is to the clean one, and what the frames of a morph look like."""
import numpy as np
import scipy.sparse as sparse
from scipy.spatial import cKDTree

from quality_meshes import mean_edge, vertex_normals


def dot(a, b):
    return np.einsum("...i,...i->...", a, b)


def unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), np.finfo(float).tiny)


def face_vectors(points, faces):
    """Normals, twice the area long."""
    return np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])


def edges_of(faces):
    """Edges (a < b), and how many faces each has."""
    return np.unique(np.sort(np.concatenate([faces[:, [1, 2]], faces[:, [2, 0]], faces[:, [0, 1]]]), axis=1), axis=0, return_counts=True)


def volume(points, faces):
    return dot(points[faces[:, 0]], np.cross(points[faces[:, 1]], points[faces[:, 2]])).sum() / 6


def umbrella(faces, count):
    """The matrix that takes points to the mean of their neighbours minus themselves."""
    edges, _ = edges_of(faces)
    rows, columns = np.concatenate([edges, edges[:, ::-1]]).T
    valence = np.maximum(np.bincount(rows, minlength=count), 1)
    means = sparse.coo_matrix((1 / valence[rows], (rows, columns)), (count, count)).tocsr()
    return means - sparse.diags((np.bincount(rows, minlength=count) > 0).astype(float))


def segment_distances(p, a, b):
    along = np.clip(dot(p - a, b - a) / np.maximum(dot(b - a, b - a), np.finfo(float).tiny), 0, 1)
    return np.linalg.norm(a + along[..., None] * (b - a) - p, axis=-1)


def triangle_distances(p, a, b, c):
    """Of points to triangles, element by element: to the plane where the foot is inside, else to the nearest side."""
    normal = np.cross(b - a, c - a)
    length = np.maximum(np.linalg.norm(normal, axis=-1), np.finfo(float).tiny)
    inside = np.all([dot(np.cross(y - x, p - x), normal) >= 0 for x, y in ((a, b), (b, c), (c, a))], axis=0)
    sides = np.minimum(np.minimum(segment_distances(p, a, b), segment_distances(p, b, c)), segment_distances(p, c, a))
    return np.where(inside, np.abs(dot(p - a, normal)) / length, sides)


class Surface:
    """Distances to a triangle mesh. Large triangles are cut in four until none is larger than the median was, so that a triangle's centre says where it is."""

    def __init__(self, points, faces):
        triangles = points[faces]
        radius = lambda t: np.linalg.norm(t - t.mean(axis=1, keepdims=True), axis=2).max(axis=1)
        largest = np.median(radius(triangles))
        while (is_large := radius(triangles) > largest).any():
            large = triangles[is_large]
            a, b, c = ((large[:, i] + large[:, j]) / 2 for i, j in ((1, 2), (2, 0), (0, 1)))
            cut = [np.stack(corners, axis=1) for corners in ((large[:, 0], c, b), (c, large[:, 1], a), (b, a, large[:, 2]), (a, b, c))]
            triangles = np.concatenate([triangles[~is_large], *cut])
        self.corners, self.radius = triangles.transpose(1, 0, 2), radius(triangles).max()
        self.tree = cKDTree(triangles.mean(axis=1))

    def distances(self, points, exact):
        """Exact: looks at more triangles until those left out are too far away to matter. Else at the six whose centres are nearest, right for most points."""
        distances, todo, count = np.full(len(points), np.inf), np.arange(len(points)), 16 if exact else 6
        while len(todo):
            count = min(count, self.tree.n)
            to_centre, which = self.tree.query(points[todo], count)
            found = triangle_distances(points[todo][:, None], *(corner[which] for corner in self.corners)).min(axis=1)
            distances[todo] = found
            if not exact or count == self.tree.n:
                break
            todo, count = todo[to_centre[:, -1] - self.radius < found], 2 * count
        return distances


class Clean:
    """The mesh without noise, which results are held against."""

    def __init__(self, points, faces):
        self.points, self.faces, self.surface = points, faces, Surface(points, faces)
        self.used = np.unique(faces)
        self.edge, self.diagonal = mean_edge(points, faces), np.linalg.norm(np.ptp(points[self.used], axis=0))
        self.directions, self.normals = unit(face_vectors(points, faces)), vertex_normals(points, faces)
        self.umbrella = umbrella(faces, len(points))
        self.bumps = dot(self.umbrella @ points, self.normals)
        self.is_closed = (edges_of(faces)[1] == 2).all()

    def rms(self, points):
        """To choose settings by, in model units: of 10,000 vertices or a few more, nearly exact."""
        some = self.used[::max(1, len(self.used) // 10000)]
        return np.sqrt(np.mean(self.surface.distances(points[some], exact=False)**2))

    def measure(self, points):
        """rms, max: distances of the vertices to the clean surface, mean edge lengths; of_diagonal: rms in units of the bounding box's diagonal.
        angle: between the normals of a face now and before the noise, degrees, mean over the faces.
        volume: change in percent, None with a boundary.
        detail: with h_i the umbrella vector of vertex i (mean of its neighbours minus itself) along the clean mesh's normal: sum h_i h_i(clean) / sum
        h_i(clean)^2, the share of the clean mesh's high frequencies that is there still. Noise does not count, as it has nothing to do with h(clean)."""
        distances = self.surface.distances(points[self.used], exact=True)
        angles = np.degrees(np.arccos(np.clip(dot(unit(face_vectors(points, self.faces)), self.directions), -1, 1)))
        return {
            "rms": np.sqrt(np.mean(distances**2)) / self.edge,
            "of_diagonal": np.sqrt(np.mean(distances**2)) / self.diagonal,
            "max": distances.max() / self.edge,
            "angle": angles.mean(),
            "volume": 100 * (volume(points, self.faces) / volume(self.points, self.faces) - 1) if self.is_closed else None,
            "detail": dot(dot(self.umbrella @ points, self.normals), self.bumps) / dot(self.bumps, self.bumps),
        }


# ---------------------------------------------------------------- morphs

def extent(points):
    """The least of the three root mean squares of the points along their principal axes."""
    return np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[-1] / np.sqrt(len(points))


def folded(points, faces):
    """Faces that look against their surroundings: more than 90 degrees from the area-weighted mean normal of the other faces that share a vertex with them."""
    vectors = face_vectors(points, faces)
    rings = np.stack([np.bincount(faces.ravel(), np.repeat(vectors[:, axis], 3), len(points)) for axis in range(3)], axis=1)
    return dot(rings[faces].sum(axis=1) - 3 * vectors, vectors) < 0


def area(points, faces):
    return np.linalg.norm(face_vectors(points, faces), axis=1).sum() / 2


def measure_morph(frames, start, end, faces):
    """frames: the points of all frames, the first is the start.
    extent, area: least of the frames over the smaller of both ends; below 1 where the shape dips on its way.
    folded: most faces in one frame that look against their surroundings and do so at neither end.
    left: what is missing to the end after the last frame, of the whole way (root mean squares over the vertices).
    step: the longest step between frames over the mean one.
    fine: where half of the difference to the end is left, the share that is left of its umbrella vectors: 0.5 on straight lines, less where fine differences
    fade first."""
    ends = folded(start, faces) | folded(end, faces)
    steps = [np.linalg.norm(b - a) for a, b in zip(frames, frames[1:])]
    to_neighbours = umbrella(faces, len(start))
    coarse, fine = np.array([(np.linalg.norm(points - end), np.linalg.norm(to_neighbours @ (points - end))) for points in frames]).T
    return {
        "extent": min(extent(points) for points in frames) / min(extent(start), extent(end)),
        "area": min(area(points, faces) for points in frames) / min(area(start, faces), area(end, faces)),
        "folded": int(max((folded(points, faces) & ~ends).sum() for points in frames)),
        "left": coarse[-1] / coarse[0],
        "step": max(steps) / np.mean(steps),
        "fine": np.interp(0.5, coarse[::-1] / coarse[0], fine[::-1] / fine[0]),
    }
