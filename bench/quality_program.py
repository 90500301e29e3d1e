# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program limitcl on points and faces in memory, by way of files in double."""
import json
import os
import subprocess

from quality_meshes import read_mesh, read_ply_polygons, write_obj, write_ply


class Limitcl:
    def __init__(self, program, device, folder):
        """folder: for the files between; device: None or what --device takes."""
        self.program, self.folder = program, folder
        self.device = ["--device", device] if device else []

    def run(self, *words):
        """Seconds of the work on the arrays: all that the report counts but reading and writing."""
        command = [self.program, *words, "--precision", "double", "--quiet", "--no-progress", "--report", "-", *self.device]
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if result.returncode != 0:
            raise RuntimeError(f"{' '.join(command)} gave exit code {result.returncode}: {result.stderr.strip()}")
        seconds = json.loads(result.stdout)["seconds"]
        return seconds["total"] - seconds["read"] - seconds["write"]

    def file(self, name, points, faces):
        path = os.path.join(self.folder, name)
        write_ply(path, points, faces)
        return path

    def path(self, name):
        return os.path.join(self.folder, name)

    def polygon_file(self, name, mesh):
        write_obj(self.path(name), mesh)
        return self.path(name)

    def polygons(self, *words):
        """What a command that takes -o gives."""
        self.run(*words, "-o", self.path("polygons.ply"))
        return read_ply_polygons(self.path("polygons.ply"))

    def denoise(self, points, faces, words):
        """Points and seconds."""
        out = os.path.join(self.folder, "out.ply")
        seconds = self.run("denoise", self.file("in.ply", points, faces), "-o", out, *words)
        return read_mesh(out)[0], seconds

    def morph(self, start, end, faces, frames, words):
        """The points of frames + 1 frames."""
        pattern = os.path.join(self.folder, "frame_%03d.ply")
        self.run("morph", self.file("from.ply", start, faces), self.file("to.ply", end, faces), "-o", pattern, "--frames", str(frames), *words)
        return [read_mesh(pattern % number)[0] for number in range(frames + 1)]
