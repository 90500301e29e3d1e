# SPDX-License-Identifier: BSD-3-Clause
"""Meshes for bench/quality: reading and writing, shapes of its own, and those of a collection of meshes (environment LIMITCL_MESHES).

Points are n x 3 doubles, faces of triangle meshes f x 3 indices; meshes of any polygons are Polygons."""
import dataclasses
import gzip
import os

import numpy as np
from scipy.spatial import Delaunay

PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4", "double": "f8",
             "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"}


@dataclasses.dataclass
class Polygons:
    """points: n x 3; degrees: corners of each face; corners: the vertices of all faces, one after the other."""
    points: np.ndarray
    degrees: np.ndarray
    corners: np.ndarray

    @staticmethod
    def of_faces(points, faces):
        """faces: f x d indices, or a list of lists."""
        corners = np.concatenate([np.asarray(face) for face in faces]).astype(np.int64)
        return Polygons(np.asarray(points, float), np.array([len(face) for face in faces]), corners)

    def starts(self):
        return np.cumsum(self.degrees) - self.degrees

    def next_corners(self):
        """Every face turned by one corner."""
        turned = np.roll(self.corners, -1)
        turned[self.starts() + self.degrees - 1] = self.corners[self.starts()]
        return turned

    def triangles(self):
        """Every face as a fan round its first corner: f x 3."""
        face, here = np.repeat(np.arange(len(self.degrees)), self.degrees), np.arange(len(self.corners))
        place = here - self.starts()[face]
        last = here[(place > 0) & (place < self.degrees[face] - 1)]
        return np.stack([self.corners[self.starts()[face[last]]], self.corners[last], self.corners[last + 1]], axis=1)

    def covering(self):
        """Triangles, and how much each of them counts: the mean of two fans, round the first and the second corner, so that quads look alike from all four."""
        if (self.degrees == 3).all():
            return self.triangles(), np.ones(len(self.degrees))
        faces = np.concatenate([self.triangles(), Polygons(self.points, self.degrees, self.next_corners()).triangles()])
        return faces, np.full(len(faces), 0.5)

    def edges(self):
        """e x 2, each once."""
        return np.unique(np.sort(np.stack([self.corners, self.next_corners()], axis=1), axis=1), axis=0)

    def triangulated(self):
        """The same surface as a mesh of triangles: fans, or quads cut along their shorter diagonals, whichever has more vertices with six edges, as suits the
        schemes of triangles."""
        turned, quads = self.corners.copy(), self.starts()[self.degrees == 4, None] + np.arange(4)
        a, b, c, d = (self.points[self.corners[quads[:, i]]] for i in range(4))
        is_other = np.linalg.norm(d - b, axis=1) < (1 - 1e-9) * np.linalg.norm(c - a, axis=1)
        turned[quads[is_other]] = np.roll(self.corners[quads[is_other]], -1, axis=1)
        found = [self.triangles(), Polygons(self.points, self.degrees, turned).triangles()]
        return Polygons.of_faces(self.points, max(found, key=lambda faces: (np.bincount(faces.ravel()) == 6).sum()))


# ---------------------------------------------------------------- files

def read_obj(text):
    points, faces = [], []
    for line in text.splitlines():
        if line.startswith("v "):
            points.append([float(word) for word in line.split()[1:4]])
        elif line.startswith("f "):
            faces.append([int(word.split("/")[0]) - 1 for word in line.split()[1:]])
    return points, faces


def read_off(text):
    """Counts, points, faces; nothing behind a face's corners."""
    words = iter(text.split()[1:])
    point_count, face_count, _ = (int(next(words)) for _ in range(3))
    points = [[float(next(words)) for _ in range(3)] for _ in range(point_count)]
    return points, [[int(next(words)) for _ in range(int(next(words)))] for _ in range(face_count)]


def read_polygons(path):
    """OBJ or OFF."""
    with (gzip.open if path.endswith(".gz") else open)(path, "rt") as file:
        text = file.read()
    return Polygons.of_faces(*(read_off if text.startswith("OFF") else read_obj)(text))


def write_obj(path, mesh):
    ends = mesh.starts() + mesh.degrees
    with open(path, "w") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in mesh.points.tolist())
        file.writelines("f " + " ".join(map(str, mesh.corners[end - degree:end] + 1)) + "\n" for degree, end in zip(mesh.degrees, ends))


def read_ply_polygons(path):
    """What limitcl writes from write_obj's files: three doubles a vertex; lists of a byte and integers."""
    with open(path, "rb") as file:
        header, body = file.read().split(b"end_header\n", 1)
    vertex_count, face_count = (int(line.split()[2]) for line in header.decode().splitlines() if line.startswith("element"))
    points = np.frombuffer(body, "<f8", 3 * vertex_count).reshape(-1, 3)
    lists, at, degrees = memoryview(body)[points.nbytes:], 0, np.empty(face_count, np.int64)
    for face in range(face_count):
        degrees[face] = lists[at]
        at += 1 + 4 * lists[at]
    is_index = np.ones(at, bool)
    is_index[np.cumsum(1 + 4 * degrees) - 1 - 4 * degrees] = False
    return Polygons(points, degrees, np.frombuffer(np.frombuffer(lists, np.uint8)[is_index].tobytes(), "<i4").astype(np.int64))


def read_ply(data):
    """Binary little-endian, triangles only: what limitcl writes from write_ply's files, and what the collection's morphs are."""
    header, body = data.split(b"end_header\n", 1)
    elements = []
    for words in (line.split() for line in header.decode().splitlines()):
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property" and words[1] == "list":
            elements[-1][2].extend([("count", "<" + PLY_TYPES[words[2]]), (words[4], "<" + PLY_TYPES[words[3]], 3)])
        elif words[0] == "property":
            elements[-1][2].append((words[2], "<" + PLY_TYPES[words[1]]))
    found, offset = {}, 0
    for name, count, properties in elements:
        found[name] = np.frombuffer(body, np.dtype(properties), count, offset)
        offset += found[name].nbytes
    points = np.stack([found["vertex"][axis] for axis in "xyz"], axis=1).astype(float)
    face = found["face"]
    if not (face["count"] == 3).all():
        raise ValueError("a PLY file with faces that are no triangles")
    return points, face[face.dtype.names[1]].astype(np.int64)


def read_mesh(path):
    with (gzip.open if path.endswith(".gz") else open)(path, "rb") as file:
        data = file.read()
    if data.startswith(b"ply"):
        return read_ply(data)
    points, faces = read_obj(data.decode())
    return np.array(points), np.array(faces)


def write_ply(path, points, faces):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n" + "".join(f"property double {axis}\n" for axis in "xyz")
    header += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    records = np.empty(len(faces), np.dtype([("count", "u1"), ("vertices", "<i4", 3)]))
    records["count"], records["vertices"] = 3, faces
    with open(path, "wb") as file:
        file.write(header.encode() + points.astype("<f8").tobytes() + records.tobytes())


# ---------------------------------------------------------------- shapes of its own

def icosphere(levels):
    """An icosahedron, every triangle cut into four `levels` times, on the unit sphere: 10 x 4^levels + 2 vertices."""
    golden = (1 + 5**0.5) / 2
    points = np.array([p for a in (-1, 1) for b in (-golden, golden) for p in ((0, a, b), (a, b, 0), (b, 0, a))], float)
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < 2.1
    faces = np.array([(i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[k, i]])
    inwards = np.einsum("ij,ij->i", points[faces[:, 0]], np.cross(points[faces[:, 1]], points[faces[:, 2]])) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    for _ in range(levels):
        sides = np.sort(np.concatenate([faces[:, [1, 2]], faces[:, [2, 0]], faces[:, [0, 1]]]), axis=1)
        edges, which = np.unique(sides, axis=0, return_inverse=True)
        a, b, c = which.reshape(3, -1) + len(points)
        points = np.concatenate([points, points[edges].mean(axis=1)])
        faces = np.concatenate([np.stack(corners, axis=1) for corners in ((faces[:, 0], c, b), (c, faces[:, 1], a), (b, a, faces[:, 2]), (a, b, c))])
    return points / np.linalg.norm(points, axis=1, keepdims=True), faces


def blob(levels):
    """A smooth closed surface without a symmetry."""
    directions, faces = icosphere(levels)
    x, y, z = directions.T
    radius = 1 + 0.25 * np.sin(3 * x + 1) * np.cos(2 * y) + 0.15 * np.sin(5 * z + 2 * x) + 0.08 * np.cos(7 * y - 3 * z)
    return radius[:, None] * directions, faces


def ribbed_torus(around, across):
    """A torus with ribs ten edges apart: fine detail that a filter should leave."""
    u, v = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across, indexing="ij")
    radius = 0.4 + 0.03 * np.cos(u * (around // 10)) * (1 + np.cos(v))
    points = np.stack([(1 + radius * np.cos(v)) * np.cos(u), (1 + radius * np.cos(v)) * np.sin(u), radius * np.sin(v)], axis=2).reshape(-1, 3)
    i, j = (index.ravel() for index in np.meshgrid(np.arange(around), np.arange(across), indexing="ij"))
    corner = lambda di, dj: (i + di) % around * across + (j + dj) % across
    return points, np.concatenate([np.stack([corner(0, 0), corner(1, 0), corner(1, 1)], axis=1), np.stack([corner(0, 0), corner(1, 1), corner(0, 1)], axis=1)])


def is_inside(points, loops):
    """Even-odd rule; loops: closed polygons, k x 2."""
    inside = np.zeros(len(points), bool)
    x, y = points.T[:, :, None]
    for loop in loops:
        (ax, ay), (bx, by) = loop.T, np.roll(loop, -1, axis=0).T
        with np.errstate(divide="ignore", invalid="ignore"):
            inside ^= (((ay > y) != (by > y)) & (x < ax + (y - ay) * (bx - ax) / (by - ay))).sum(axis=1) % 2 == 1
    return inside


def profile(spacing):
    """The part's outline, anticlockwise, and its round hole, clockwise."""
    arc = lambda centre, radius, start, end: (lambda t: np.stack([centre[0] + radius * np.cos(t), centre[1] + radius * np.sin(t)], axis=1))(
        np.linspace(start, end, round(abs(end - start) * radius / spacing), endpoint=False))
    line = lambda a, b: np.linspace(a, b, round(float(np.hypot(*np.subtract(b, a))) / spacing), endpoint=False)
    outline = [line((0, 0), (4, 0)), line((4, 0), (4, 1)), arc((4, 3), 2, -np.pi / 2, -np.pi), line((2, 3), (2, 4)), arc((1, 4), 1, 0, np.pi),
               line((0, 4), (0, 0))]
    return [np.concatenate(outline), arc((1.1, 1.1), 0.6, 2 * np.pi, 0)]


def part(spacing):
    """A machined part: an outline of lines and arcs with a hole, extruded. Sharp edges, straight and curved, convex and concave, and a smooth transition."""
    loops = profile(spacing)
    rim = np.concatenate(loops)
    lattice = np.stack(np.meshgrid(np.arange(0, 4, spacing), np.arange(0, 5, spacing * 3**0.5 / 2), indexing="ij"), axis=2)
    lattice[:, ::2, 0] += spacing / 2
    lattice = lattice.reshape(-1, 2)
    free = np.linalg.norm(lattice[:, None] - rim[None], axis=2).min(axis=1) > 0.7 * spacing
    flat = np.concatenate([rim, lattice[free & is_inside(lattice, loops)]])
    cap = Delaunay(flat).simplices
    cap = cap[is_inside(flat[cap].mean(axis=1), loops)]
    ab, ac = flat[cap[:, 1]] - flat[cap[:, 0]], flat[cap[:, 2]] - flat[cap[:, 0]]
    clockwise = ab[:, 0] * ac[:, 1] < ab[:, 1] * ac[:, 0]
    cap[clockwise] = cap[clockwise][:, ::-1]

    rows = 15  # of the wall
    heights = np.linspace(0, 1.5, rows + 1)
    lift = lambda points, height: np.column_stack([points, np.full(len(points), height)])
    points = np.concatenate([lift(flat, 0), lift(flat, heights[-1])] + [lift(rim, height) for height in heights[1:-1]])
    starts = [0] + [2 * len(flat) + k * len(rim) for k in range(rows - 1)] + [len(flat)]
    here = np.arange(len(rim))
    after = np.concatenate([np.roll(here[:len(loops[0])], -1), np.roll(here[len(loops[0]):], -1)])
    walls = []
    for below, above in zip(starts, starts[1:]):
        walls += [np.stack([below + here, below + after, above + after], axis=1), np.stack([below + here, above + after, above + here], axis=1)]
    return points, np.concatenate([cap[:, ::-1], cap + len(flat)] + walls)


def eared(levels):
    """A head with two long ears that bend backwards, and the sphere of the same connectivity."""
    sphere, faces = icosphere(levels)
    radius = 1 + 0.1 * np.sin(3 * sphere[:, 0]) + 0.1 * sphere[:, 1]**3
    for side in (-0.45, 0.45):
        ear = np.array([side, 0.1, 1]) / np.linalg.norm([side, 0.1, 1])
        radius += 1.5 * np.exp(-(np.arccos(np.clip(sphere @ ear, -1, 1)) / 0.22)**2)
    points = radius[:, None] * sphere
    points[:, 1] += 0.25 * np.maximum(points[:, 2] - 0.8, 0)**2
    return points, sphere, faces


def turned(points, degrees):
    """About an axis that is none of the coordinates'."""
    axis = np.array([1, 2, 0.5]) / np.linalg.norm([1, 2, 0.5])
    cross = np.cross(np.eye(3), axis)
    angle = np.radians(degrees)
    return points @ (np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)


def boxes(cells):
    """The surface of unit cubes at whole places: Polygons of quads."""
    cells, faces = set(cells), []
    for cell in sorted(cells):
        for axis in range(3):
            for side in (0, 1):
                beside = tuple(cell[i] + (2 * side - 1) * (i == axis) for i in range(3))
                if beside not in cells:
                    a, b = (np.eye(3, dtype=int)[(axis + turn) % 3] for turn in ((1, 2) if side else (2, 1)))
                    corner = np.array(cell) + side * np.eye(3, dtype=int)[axis]
                    faces.append([corner, corner + a, corner + a + b, corner + b])
    points, corners = np.unique(np.array(faces).reshape(-1, 3), axis=0, return_inverse=True)
    return Polygons.of_faces(points, corners.reshape(-1, 4))


def octahedron():
    points = np.concatenate([np.eye(3), -np.eye(3)])
    return points, np.array([(x, y, z) if (x + y + z) % 2 else (x, z, y) for x in (0, 3) for y in (1, 4) for z in (2, 5)])


def quad_torus(around, across, noise):
    """Radii 1 and 0.4; Gaussian noise along the normals, its standard deviation `noise` mean edge lengths."""
    u, v = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across, indexing="ij")
    normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=2).reshape(-1, 3)
    points = np.stack([np.cos(u), np.sin(u), 0 * u], axis=2).reshape(-1, 3) + 0.4 * normals
    here = np.arange(around * across).reshape(around, across)
    faces = np.stack([here, np.roll(here, -1, 0), np.roll(here, (-1, -1), (0, 1)), np.roll(here, -1, 1)], axis=2).reshape(-1, 4)
    edge = np.mean([np.linalg.norm(points[faces[:, i]] - points[faces[:, i - 1]], axis=1).mean() for i in (1, 2)])
    return Polygons.of_faces(points + np.random.default_rng(7).normal(0, noise * edge, (len(points), 1)) * normals, faces)


# ---------------------------------------------------------------- cases

def vertex_normals(points, faces):
    """Area-weighted, unit length; 0 where no face is."""
    normals = np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    sums = np.stack([np.bincount(faces.ravel(), np.repeat(normals[:, axis], 3), len(points)) for axis in range(3)], axis=1)
    return sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), np.finfo(float).tiny)


def mean_edge(points, faces):
    return np.mean([np.linalg.norm(points[faces[:, i]] - points[faces[:, i - 1]], axis=1).mean() for i in range(3)])


def with_noise(points, faces, level):
    """Gaussian along the normals, its standard deviation `level` mean edge lengths; the same in every run."""
    return points + np.random.default_rng(7).normal(0, level * mean_edge(points, faces), (len(points), 1)) * vertex_normals(points, faces)


def fitted(points, target):
    """Scaled and moved so that corresponding points come closest, in the mean of squares."""
    a, b = points - points.mean(axis=0), target - target.mean(axis=0)
    return a * ((a * b).sum() / (a * a).sum()) + target.mean(axis=0)


def collection(name):
    """A path below LIMITCL_MESHES, or None."""
    path = os.path.join(os.environ.get("LIMITCL_MESHES", ""), name)
    return path if os.environ.get("LIMITCL_MESHES") and os.path.exists(path) else None


def denoise_cases(quick, left_out):
    """(name, clean points, noisy points, faces) one by one. The collection's noise is its own; the two files of trim-star were scaled to one box each, noise
    and all, so that the noisy one is fitted to the clean one first."""
    for name, (points, faces) in {"blob": blob(4 if quick else 5), "part": part(0.15 if quick else 0.1)}.items():
        yield f"{name}, 0.3", points, with_noise(points, faces, 0.3), faces
    if quick:
        return
    points, faces = ribbed_torus(120, 50)
    yield "torus, 0.2", points, with_noise(points, faces, 0.2), faces
    pairs = [(name, f"{name}_Original", f"{name}_Noisy") for name in ("Block0.4", "Fandisk0.7", "SharpSphere0.3", "Bunny0.2")]
    for name, clean, noisy in [*pairs, ("trim-star", "trim-star", "trim-star_noisy")]:
        files = [collection(f"noisy/{file}.obj.gz") for file in (clean, noisy)]
        if None in files:
            left_out.append(f"{name}: LIMITCL_MESHES has no noisy/{clean}.obj.gz and {noisy}.obj.gz")
            continue
        points, faces = read_mesh(files[0])
        noisy_points = read_mesh(files[1])[0]
        yield name, points, fitted(noisy_points, points) if name == "trim-star" else noisy_points, faces


def morph_cases(quick, left_out):
    """(name, points from, points to, faces) one by one."""
    head, sphere, faces = eared(4 if quick else 5)
    yield "eared head to sphere", head, sphere, faces
    yield "eared head to the sphere turned by 120 degrees", head, turned(sphere, 120), faces
    points, faces = blob(4 if quick else 5)
    yield "blob to its mirror image", points, points * [-1, 1, 1], faces
    pairs = {"cortex to sphere (fsaverage5)": ("fsaverage5_left_white.ply.gz", "fsaverage5_left_sphere.ply.gz"),
             "cheburashka, pose 1 to 9": ("cheburashka-01.obj.gz", "cheburashka-09.obj.gz")}
    for name, names in pairs.items():
        files = [collection(f"morph/{file}") for file in names]
        if None in files:
            left_out.append(f"{name}: LIMITCL_MESHES has no morph/{names[0]} and {names[1]}")
        elif not quick:
            (start, faces), (end, _) = (read_mesh(file) for file in files)
            yield name, start, end, faces


SHAPES = {"bumpy": "tri/bumpy.off", "hand": "tri/cgal_hand.off", "fandisk": "quad/fandisk_quads.off"}


def shape_cases(quick, left_out):
    """(name, Polygons), closed: few vertices, then many."""
    from quality_butterfly import middles, refine
    yield "cube", boxes([(0, 0, 0)])
    yield "icosahedron", Polygons.of_faces(*icosphere(0))
    if quick:
        return
    yield "L of three cubes", boxes([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    yield "octahedron, cut once", Polygons.of_faces(*refine(*octahedron(), 1, middles))
    yield "torus of 6 x 4 quads", quad_torus(6, 4, 0)
    yield "star", read_polygons(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "examples", "star.obj"))
    yield "torus of 32 x 16 quads, noise 0.1", quad_torus(32, 16, 0.1)
    for name, file in SHAPES.items():
        if collection(file):
            yield name, read_polygons(collection(file))
        else:
            left_out.append(f"{name}: LIMITCL_MESHES has no {file}")
