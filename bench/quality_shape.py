# SPDX-License-Identifier: BSD-3-Clause
"""How good the shape of interpolating surfaces is: the ways to interpolate that bench/quality compares, what it measures of them, and on which meshes."""
import numpy as np

import quality_butterfly
from quality_measures import Surface, dot, face_vectors, unit
from quality_meshes import Polygons, read_ply_polygons, vertex_normals

MOST_TRIANGLES = 160000  # of the samples: the finest level whose triangles, four times as many a level, are not more
FINEST = 6
EXACT_NOISE = 60  # up to so many vertices every unit impulse is interpolated, more or less; else Gaussian noise
NOISE_VALUES = 4500  # random ones at least: the gain's standard deviation is about 1.5 %
NOISE_LEVEL = 3


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
        has_control = control and not self.refined
        words, done = (["--scheme", "catmull-clark"], 1) if self.refined else (self.words, 0)
        refine = lambda level, *more: self.limitcl.polygons("refine", control or path, *words, "--levels", str(level - done), *more)
        missed = self.missed_of_faces if "doo-sabin" in self.words else lambda mesh, refine: refine(1, "--limit").points[:len(mesh.points)] - mesh.points
        return Fit(read_ply_polygons(control).points if has_control else None, lambda level: refine(level, "--limit"),
                   lambda: np.linalg.norm(missed(mesh, refine), axis=1).max())

    @staticmethod
    def missed_of_faces(mesh, refine):
        """The limit point of a vertex is the centroid of its face of the first refinement, the last faces in their order."""
        fine = refine(1)
        own = slice(len(mesh.degrees) + len(mesh.edges()), None)
        starts, degrees = fine.starts()[own], fine.degrees[own]
        sums = np.add.reduceat(fine.points[fine.corners[starts[0]:]], starts - starts[0], axis=0)
        return sums / degrees[:, None] - mesh.points


class Local:
    """A rule that places new vertices and never moves old ones."""
    needs_triangles = True

    def __init__(self, name, rule, is_plain=False):
        self.name, self.rule, self.is_plain = name, rule, is_plain

    def fit(self, mesh):
        sample = lambda level: Polygons.of_faces(*quality_butterfly.refine(mesh.points, mesh.corners.reshape(-1, 3), level, self.rule))
        return Fit(None, sample, lambda: 0.0)


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


def noise_draws(count):
    """n x 3 arrays. Up to EXACT_NOISE vertices the columns of all are orthonormal: the sum of squares of what they become is exactly that of white noise."""
    random = np.random.default_rng(11)
    if count > EXACT_NOISE:
        draws = -(-NOISE_VALUES // (3 * count))
        return [random.normal(size=(count, 3)) for _ in range(draws)], 3 * draws
    columns = np.linalg.qr(random.normal(size=(count, count)))[0]
    columns = np.hstack([columns, np.zeros((count, -count % 3))])
    return [columns[:, i:i + 3] for i in range(0, columns.shape[1], 3)], 1


def noise_gains(method, mesh):
    """White noise of unit variance at the vertices: its root mean square in the control points (math: rows of A^-1), and on the surface, at samples even in the
    parameters. All methods are linear in the points."""
    draws, columns = noise_draws(len(mesh.points))
    in_control, on_surface = [], []
    for draw in draws:
        fit = method.fit(Polygons(draw, mesh.degrees, mesh.corners))
        samples = fit.sample(NOISE_LEVEL if len(mesh.points) <= EXACT_NOISE else NOISE_LEVEL - 1).points
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
        departure: largest distance of a sample to the faces of the mesh, mean edge lengths.
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
