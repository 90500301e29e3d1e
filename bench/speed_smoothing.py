#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""speed_smoothing.py FILE.ply --runs N: times the smoothing filters of VTK and MeshLab on a mesh, ten passes each, and prints the lines that bench/run reads.

A pass moves every vertex once by its neighbours: an iteration of VTK's windowed sinc is one, a step of Taubin's filter two. Files, triangulation and copies are not timed.
"""
import argparse
import sys
import time

PASSES = 10


def windowed_sinc(path):
    import vtk
    reader = vtk.vtkPLYReader()
    reader.SetFileName(path)
    reader.Update()
    smoother = vtk.vtkWindowedSincPolyDataFilter()
    smoother.SetInputData(reader.GetOutput())
    smoother.SetNumberOfIterations(PASSES)

    def run():
        smoother.Modified()
        start = time.perf_counter()
        smoother.Update()
        return time.perf_counter() - start
    return run


def taubin(path):
    import pymeshlab
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(path)

    def run():
        start = time.perf_counter()
        meshes.apply_coord_taubin_smoothing(stepsmoothnum=PASSES // 2)
        return time.perf_counter() - start
    return run


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--runs", type=int, default=7)
    options = parser.parse_args()
    contestants = {}
    for name, make in (("smoothing.windowed-sinc", windowed_sinc), ("smoothing.taubin", taubin)):
        try:
            contestants[name] = make(options.file)
        except ImportError as error:
            print(f"{name}: {error}", file=sys.stderr)
    times = {name: [] for name in contestants}
    for is_counted in [False] + [True] * options.runs:
        for name, run in contestants.items():
            seconds = run()
            if is_counted:
                times[name].append(seconds)
    for name, seconds in times.items():
        print("times", name, *seconds)


if __name__ == "__main__":
    main()
