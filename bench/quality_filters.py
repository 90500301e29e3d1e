# SPDX-License-Identifier: BSD-3-Clause
"""The ways to denoise that bench/quality compares, each with the settings it tries."""
import itertools
import time

import numpy as np
import scipy.sparse as sparse

from quality_measures import dot, edges_of, face_vectors, unit


class Method:
    """name; settings: (what to call it, function that takes (noisy points, faces) to (points, seconds)); on_closed: None, or a function that takes the words of
    the best setting to one more, for closed meshes."""

    def __init__(self, name, settings, on_closed=None):
        self.name, self.settings, self.on_closed = name, settings, on_closed


def timed(function, *arguments):
    start = time.perf_counter()
    result = function(*arguments)
    return result, time.perf_counter() - start


# ---------------------------------------------------------------- limitcl

def limitcl_methods(limitcl, quick):
    """limitcl: quality_program.Limitcl. Loop's limit operator, since all meshes are of triangles, and the operator that keeps features."""
    def setting(*words):
        return " ".join(words), lambda points, faces: limitcl.denoise(points, faces, words)

    def grid(pairs, *more):
        return [setting("--m", str(m), "--k", str(k), *more) for m, k in pairs]

    smooth = [(1, 6), (2, 6)] if quick else [(0, 2), (0, 4), (1, 6), (1, 12), (1, 25), (1, 50), (1, 100), (2, 50), (2, 200)]
    features = [(1, 12), (1, 50)] if quick else [(1, 12), (1, 25), (1, 50), (1, 100), (1, 200), (2, 50), (2, 200)]
    def kept(words):
        return setting(*words.split(), "--keep-volume")

    return [
        Method("limitcl denoise, no options", [setting()]),
        Method("limitcl denoise, D^k A", grid(smooth), kept),
        Method("limitcl denoise --plain, D^k", grid(smooth, "--plain"), kept),
        Method("limitcl denoise --operator features, no more options", [setting("--operator", "features")]),
        Method("limitcl denoise --operator features", grid(features, "--operator", "features"), kept),
    ]


# ---------------------------------------------------------------- PyMeshLab and VTK

def pymeshlab_methods(quick):
    import pymeshlab

    def setting(words, filter_name, times=1, **parameters):
        def run(points, faces):
            meshes = pymeshlab.MeshSet()
            meshes.add_mesh(pymeshlab.Mesh(points, faces))
            _, seconds = timed(lambda: [meshes.apply_filter(filter_name, **parameters) for _ in range(times)])
            return meshes.current_mesh().vertex_matrix(), seconds

        return words, run

    laplacian = [setting(f"{n} steps", "apply_coord_laplacian_smoothing", stepsmoothnum=n, cotangentweight=False) for n in ((3,) if quick else (1, 2, 3, 5, 8))]
    taubin = [setting(f"lambda 0.5, mu {mu}, {n} steps", "apply_coord_taubin_smoothing", lambda_=0.5, mu=mu, stepsmoothnum=n)
              for mu, n in itertools.product((-0.53, -0.51), (20,) if quick else (5, 10, 20, 40, 80))]
    hc = [setting(f"{n} times", "apply_coord_hc_laplacian_smoothing", times=n) for n in ((2,) if quick else (1, 2, 4, 8, 16))]
    values = [(60, 6, (2, 2))] if quick else itertools.product((60, 90), (6, 20), ((2, 2), (2, 1), (5, 1)))
    two_step = [setting(f"threshold {angle}, {rounds} x ({normals} + {fits}) steps", "apply_coord_two_steps_smoothing", stepsmoothnum=rounds, normalthr=angle,
                        stepnormalnum=normals, stepfitnum=fits) for angle, rounds, (normals, fits) in values]
    return [Method("Laplacian (PyMeshLab)", laplacian), Method("Taubin (PyMeshLab)", taubin), Method("HC Laplacian (PyMeshLab)", hc),
            Method("two-step (PyMeshLab)", two_step)]


def vtk_methods(quick):
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

    def poly_data(points, faces):
        data, vertices, polygons = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
        vertices.SetData(numpy_to_vtk(points, deep=True))
        offsets, corners = np.arange(0, 3 * len(faces) + 1, 3), faces.ravel().astype(np.int64)
        polygons.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(corners, deep=True))
        data.SetPoints(vertices)
        data.SetPolys(polygons)
        return data

    def setting(band):
        def run(points, faces):
            smoother = vtk.vtkWindowedSincPolyDataFilter()
            smoother.SetInputData(poly_data(points, faces))
            smoother.SetNumberOfIterations(50)
            smoother.SetPassBand(band)
            smoother.NormalizeCoordinatesOn()
            _, seconds = timed(smoother.Update)
            return vtk_to_numpy(smoother.GetOutput().GetPoints().GetData()).astype(float), seconds

        return f"pass band {band}, 50 steps", run

    return [Method("windowed sinc (VTK)", [setting(band) for band in ((0.1,) if quick else (0.3, 0.2, 0.14, 0.1, 0.07, 0.05))])]


# ---------------------------------------------------------------- bilateral normals

def bilateral_normals(points, faces, reach, range_sigma, steps):
    """Bilateral normal filtering, local scheme (Zheng, Fu, Au, Tai 2011), in NumPy, as no package at hand has it.
    Face normals: `steps` means over the faces that share a vertex, with weights area x exp(-distance^2 / 2 s^2) x exp(-|difference|^2 / 2 range_sigma^2), s
    `reach` times the mean distance of neighbouring faces' centres. Then 20 steps of the vertices towards the planes of their faces (Sun et al. 2007); the
    boundary stays."""
    corners = sparse.coo_matrix((np.ones(faces.size), (np.repeat(np.arange(len(faces)), 3), faces.ravel())), (len(faces), len(points))).tocsr()
    shared = (corners @ corners.T).tocoo()
    is_other, is_next = shared.row != shared.col, shared.data == 2
    i, j, centres, vectors = shared.row[is_other], shared.col[is_other], points[faces].mean(axis=1), face_vectors(points, faces)
    spread = reach * np.linalg.norm(centres[shared.row[is_next]] - centres[shared.col[is_next]], axis=1).mean()
    areas, normals = np.linalg.norm(vectors, axis=1), unit(vectors)
    near = areas[j] * np.exp(-dot(centres[i] - centres[j], centres[i] - centres[j]) / (2 * spread**2))
    for _ in range(steps):
        weights = near * np.exp(-dot(normals[i] - normals[j], normals[i] - normals[j]) / (2 * range_sigma**2))
        normals = unit(sparse.coo_matrix((weights, (i, j)), (len(faces), len(faces))).tocsr() @ normals + areas[:, None] * normals)

    edges, face_count = edges_of(faces)
    share = 1 / np.maximum(np.bincount(faces.ravel(), minlength=len(points)), 1)
    share[edges[face_count == 1].ravel()] = 0
    for _ in range(20):
        to_planes = [dot(normals, points[faces].mean(axis=1) - points[faces[:, corner]])[:, None] * normals for corner in range(3)]
        moves = np.stack(to_planes, axis=1).reshape(-1, 3)
        points = points + share[:, None] * np.stack([np.bincount(faces.ravel(), moves[:, axis], len(points)) for axis in range(3)], axis=1)
    return points


def bilateral_methods(quick):
    def setting(reach, range_sigma, steps):
        words = f"reach {reach}, sigma {range_sigma}, {steps} + 20 steps"
        return words, lambda points, faces: timed(bilateral_normals, points, faces, reach, range_sigma, steps)

    values = [(1, 0.35, 10)] if quick else [(1, 0.35, 10), (1, 0.5, 10), (1, 0.5, 25), (2, 0.35, 10), (2, 0.35, 25), (2, 0.5, 10)]
    return [Method("bilateral normals (NumPy)", [setting(*three) for three in values])]


# ---------------------------------------------------------------- all

def methods(limitcl, quick, left_out):
    found = limitcl_methods(limitcl, quick)
    for package, make in (("pymeshlab", pymeshlab_methods), ("vtk", vtk_methods), ("", bilateral_methods)):
        try:
            found += make(quick)
        except ImportError as error:
            left_out.append(f"the methods of {package}, which cannot be loaded: {error}")
    return found
