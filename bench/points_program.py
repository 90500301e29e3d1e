# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program limitcl on files of points, and measures the surfaces that come out."""
import array
import csv
import json
import math
import os
import subprocess
import time

from points_shapes import read_ply, triples, write_ply


class Outcome:
    """report: {} where there is none; seconds: by the clock; peak: bytes of memory."""

    def __init__(self, code, report, message, seconds, peak):
        self.code, self.report, self.message, self.seconds, self.peak = code, report, message, seconds, peak


class Limitcl:
    def __init__(self, program, device, folder):
        """folder: for the files between; device: None or what --device takes."""
        self.program, self.folder = program, folder
        self.device = ["--device", device] if device else []

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *words):
        """Any exit code."""
        report, errors = self.path("report.json"), self.path("errors.txt")
        if os.path.exists(report):
            os.remove(report)
        command = [self.program, *words, "--quiet", "--no-progress", "--report", report, *self.device]
        start = time.monotonic()
        with open(errors, "w") as file:
            child = subprocess.Popen(command, stdout=file, stderr=file)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.monotonic() - start
        with open(errors, errors="replace") as file:
            message = " ".join(file.read().split())
        try:
            with open(report) as file:
                found = json.load(file)
        except (OSError, ValueError):
            found = {}
        return Outcome(child.returncode, found, message, seconds, 1024 * usage.ru_maxrss)

    def must(self, *words):
        outcome = self.run(*words)
        if outcome.code != 0:
            raise RuntimeError(f"limitcl {' '.join(words)} gave exit code {outcome.code}: {outcome.message}")
        return outcome

    # The control mesh is an OBJ file, which holds creases and the rule at the boundary.

    def surface(self, cloud, *words):
        """cloud: a path, or an array. Path of the control mesh and the outcome; the file is only there where the exit code is 0."""
        if not isinstance(cloud, str):
            write_ply(self.path("cloud.ply"), cloud)
            cloud = self.path("cloud.ply")
        control = self.path("control.obj")
        return control, self.run("surface", cloud, "-o", control, *words)

    def samples(self, control, words):
        """Points of the limit surface, one for each vertex after two refinements."""
        self.must("refine", control, "--levels", "2", "--limit", "-o", self.path("samples.ply"), *words)
        return read_ply(self.path("samples.ply"))

    def distances(self, control, points, words):
        """From points to the limit surface, without sign."""
        write_ply(self.path("places.ply"), points)
        self.must("closest", control, "--points", self.path("places.ply"), "-o", self.path("closest.csv"), *words)
        with open(self.path("closest.csv"), newline="") as file:
            rows = csv.reader(file)
            column = next(rows).index("distance")
            return array.array("d", (abs(float(row[column])) for row in rows))

    def topology(self, control):
        """Components, genus (of all together) and whether it is closed, as `info` counts them; genus None with a boundary."""
        mesh = self.must("info", control).report["mesh"]
        euler = mesh["vertices"] - mesh["edges"] + mesh["faces"]
        is_closed = mesh["boundary_edges"] == 0
        return {"components": mesh["components"], "closed": is_closed, "genus": mesh["components"] - euler // 2 if is_closed else None}


def rms(values):
    return math.sqrt(math.fsum(v * v for v in values) / len(values)) if len(values) else 0.0


def largest(values):
    return max(values, default=0.0)


def from_shape(shape, points):
    """Distances without sign of points to a shape."""
    return array.array("d", (abs(shape.distance(*p)) for p in triples(points)))
