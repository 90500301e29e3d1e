# SPDX-License-Identifier: BSD-3-Clause
"""How good the shape of interpolating surfaces is: the ways to interpolate that bench/quality compares, what it measures of them, and on which meshes."""
import numpy as np

import quality_butterfly
from quality_measures import Surface, dot, face_vectors, unit
from quality_meshes import Polygons, quad_torus, read_ply_polygons, vertex_normals

MOST_TRIANGLES, FINEST = 160000, 5  # the finest sampling: the last level, of at most FINEST, with no more than so many triangles
EXACT_NOISE = 60  # vertices: up to so many the noise gains are exact, beyond from at least NOISE_VALUES random values, with a standard deviation of about 1.5 %
NOISE_VALUES = 4500


# ---------------------------------------------------------------- ways to interpolate

class Fit:
    """A surface. control: the control points P of the mesh, or None; sample(level): Polygons with points on the limit surface, about 4^level triangles for
    each of the mesh; missed(): largest distance of a vertex to the surface's point that belongs to it."""

    def __init__(self, control, sample, missed):
        self.control, self.sample, self.missed = control, sample, missed


class Limitcl:
    """One of limitcl's surfaces, through the program. words: the scheme and its parameters; refined: more words that make `interpolate` give M^1."""

    def __init__(self, limitcl, name, words, refined=(), is_plain=False, needs_triangles=False):
        self.limitcl, self.name, self.words, self.refined = limitcl, name, words.split(), list(refined)
        self.is_plain, self.needs_triangles = is_plain, needs_triangles

    def fit(self, mesh):
        """RuntimeError where there is no such surface."""
        path = self.limitcl.polygon_file("fit.obj", mesh)
        control = None if self.is_plain else self.limitcl.path("control.ply")
        if control:
            self.limitcl.run("interpolate", path, "-o", control, *self.words, *self.refined)
        words, done = (["--scheme", "catmull-clark"], 1) if self.refined else (self.words, 0)

        def refine(level, *more):
            return self.limitcl.polygons("refine", control or path, *words, "--levels", str(level - done), *more)

        def missed():
            met = centroids_of_vertices(mesh, refine(1)) if "doo-sabin" in words else refine(1, "--limit").points[:len(mesh.points)]
            return np.linalg.norm(met - mesh.points, axis=1).max()

        return Fit(read_ply_polygons(control).points if control and not self.refined else None, lambda level: refine(level, "--limit"), missed)


def centroids_of_vertices(mesh, fine):
    """Of the faces that the first Doo-Sabin refinement makes for the vertices, the last ones: these are the vertices' limit points."""
    own = slice(len(mesh.degrees) + len(mesh.edges()), None)
    starts, degrees = fine.starts()[own], fine.degrees[own]
    return np.add.reduceat(fine.points[fine.corners[starts[0]:]], starts - starts[0], axis=0) / degrees[:, None]


class Local:
    """A rule that places new vertices and never moves old ones."""
    needs_triangles = True

    def __init__(self, name, rule, is_plain=False):
        self.name, self.rule, self.is_plain = name, rule, is_plain

    def fit(self, mesh):
        sample = lambda level: Polygons.of_faces(*quality_butterfly.refine(mesh.points, mesh.corners.reshape(-1, 3), level, self.rule))
        return Fit(None, sample, lambda: np.linalg.norm(sample(1).points[:len(mesh.points)] - mesh.points, axis=1).max())


def methods(limitcl, quick):
    ours = [("Catmull-Clark, alpha 0", "--scheme catmull-clark"), ("Catmull-Clark, alpha 0.5", "--scheme catmull-clark --alpha 0.5"),
            *((f"two-phase, lambda {ratio}", f"--scheme catmull-clark --lambda {ratio}") for ratio in (0.2, 0.3, 0.5))]
    found = [Limitcl(limitcl, *words) for words in ours]
    found += [Limitcl(limitcl, f"two-phase, lambda 0.3, fair {weight}", "--scheme catmull-clark --lambda 0.3", ("--refined", "--fair", weight))
              for weight in (("1",) if quick else ("0.3", "1", "10", "100"))]
    return found + [Limitcl(limitcl, "Loop", "--scheme loop", needs_triangles=True), Limitcl(limitcl, "Doo-Sabin", "--scheme doo-sabin"),
                    Local("butterfly", quality_butterfly.butterfly), Local("modified butterfly", quality_butterfly.modified_butterfly),
                    Local("the polygons themselves", quality_butterfly.middles, is_plain=True),
                    Limitcl(limitcl, "the mesh as control mesh", "", is_plain=True)]


# ---------------------------------------------------------------- measures

def frames(points, faces):
    """Areas of the triangles, and for each the 2 x 3 matrix that takes the differences along its first two sides to a gradient: rows of the inverse."""
    sides = points[faces[:, 1:]] - points[faces[:, :1]]
    a, b, c = (dot(sides[:, i], sides[:, j]) for i, j in ((0, 0), (0, 1), (1, 1)))
    determinant = np.maximum(a * c - b * b, np.finfo(float).tiny)
    inverse = np.stack([c, -b, -b, a], axis=1).reshape(-1, 2, 2) / determinant[:, None, None]
    return np.sqrt(determinant) / 2, inverse @ sides


def curvature(samples):
    """(bending energy, curvature variation) of Polygons with points on the surface.
    The normals of the samples (sums of the triangles' vectors) are linear over each triangle; the symmetric part of their gradient in its plane is the shape
    operator there (Rusinkiewicz 2004). Bending energy: its squared norm k1^2 + k2^2, integrated, over that of a sphere, 8 pi.
    Curvature variation: H, half of its trace, goes to the samples (means by area); the length of its gradient, integrated: the total variation of the mean
    curvature over the surface. Both do not depend on the size, and are 1 and 0 on a sphere."""
    points, (faces, shares) = samples.points, samples.covering()
    areas, gradient = frames(points, faces)
    areas *= shares
    normals = vertex_normals(points, faces)
    turning = np.einsum("tia,tib->tab", gradient, normals[faces[:, 1:]] - normals[faces[:, :1]])
    direction = unit(face_vectors(points, faces))
    in_plane = np.eye(3) - direction[:, :, None] * direction[:, None]
    turning = in_plane @ (turning + turning.transpose(0, 2, 1)) @ in_plane / 2
    mean = np.trace(turning, axis1=1, axis2=2) / 2
    around = lambda values: np.bincount(faces.ravel(), np.repeat(values, 3), len(points))
    smooth = around(areas * mean) / np.maximum(around(areas), np.finfo(float).tiny)
    slope = np.einsum("tia,ti->ta", gradient, smooth[faces[:, 1:]] - smooth[faces[:, :1]])
    return (areas * (turning**2).sum(axis=(1, 2))).sum() / (8 * np.pi), (areas * np.linalg.norm(slope, axis=1)).sum()


def torus_check():
    """Both measures of a torus of radii 1 and 0.4 that is sampled 128 x 64 times: (measured, known) pairs. RuntimeError where they differ by more than 1 %."""
    large, small = 1, 0.4
    known = np.pi * large**2 / (2 * small * np.sqrt(large**2 - small**2)), 2 * np.pi * large / small * np.log((large + small) / (large - small))
    pairs = list(zip(curvature(quad_torus(128, 64, 0)), known))
    if any(abs(measured / value - 1) > 0.01 for measured, value in pairs):
        raise RuntimeError(f"the measures of curvature are off on a torus: measured and known values are {pairs}")
    return pairs


def noise_draws(count):
    """Arrays of n x 3, and what to divide sums of squares by. With few vertices the columns of all arrays together are orthonormal: the squares of what a
    linear method makes of them then add up to the expectation for white noise."""
    random = np.random.default_rng(11)
    if count > EXACT_NOISE:
        draws = -(-NOISE_VALUES // (3 * count))
        return [random.normal(size=(count, 3)) for _ in range(draws)], 3 * draws
    columns = np.linalg.qr(random.normal(size=(count, count)))[0]
    columns = np.hstack([columns, np.zeros((count, -count % 3))])
    return [columns[:, i:i + 3] for i in range(0, columns.shape[1], 3)], 1


def noise_gains(method, mesh):
    """White noise of unit variance at the vertices: its root mean square in the control points (of the norms of the rows of A^-1; None where there are no such
    points), and on the surface, at samples even in the parameters. All methods are linear in the points."""
    draws, columns = noise_draws(len(mesh.points))
    in_control, on_surface = [], []
    for draw in draws:
        fit = method.fit(Polygons(draw, mesh.degrees, mesh.corners))
        samples = fit.sample(3 if len(mesh.points) <= EXACT_NOISE else 2).points
        on_surface.append((samples**2).sum() / len(samples) / columns)
        if fit.control is not None:
            in_control.append((fit.control**2).sum() / len(fit.control) / columns)
    return np.sqrt(np.sum(in_control)) if in_control else None, np.sqrt(np.sum(on_surface))


class Case:
    """A mesh, and the same with its faces cut into triangles, which the departure is measured from and which schemes of triangles interpolate."""

    def __init__(self, mesh):
        self.mesh, self.triangles = mesh, mesh.triangulated()
        faces, ends = self.triangles.corners.reshape(-1, 3), mesh.points[mesh.edges()]
        self.surface = Surface(mesh.points, faces)
        self.edge, self.diagonal = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean(), np.linalg.norm(np.ptp(mesh.points, axis=0))
        self.level = min(FINEST, int(np.log(MOST_TRIANGLES / len(faces)) / np.log(4)))

    def departure(self, samples):
        return max(self.surface.distances(part, exact=True).max() for part in np.array_split(samples, 1 + len(samples) // 20000)) / self.edge

    def measure(self, method):
        """bending, variation: see curvature; each also one and two levels coarser (a list, the coarsest first).
        departure: largest distance of a sample, one level coarser, to the faces of the mesh, mean edge lengths.
        control_noise, noise: see noise_gains. missed: largest distance of a vertex to its point of the surface, of the bounding box's diagonal."""
        mesh = self.triangles if method.needs_triangles else self.mesh
        fit = method.fit(mesh)
        levels = [fit.sample(level) for level in range(self.level - 2, self.level + 1)]
        bending, variation = zip(*(curvature(samples) for samples in levels))
        missed = fit.missed() / self.diagonal
        departure = self.departure(levels[1].points)
        control_noise, noise = noise_gains(method, mesh)
        return {"bending": bending[-1], "variation": variation[-1], "departure": departure, "noise": noise, "control_noise": control_noise, "missed": missed,
                "bending_by_level": bending, "variation_by_level": variation}
