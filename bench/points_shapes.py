# SPDX-License-Identifier: BSD-3-Clause
"""Shapes that bench/points draws its clouds from: points at random, uniform by area where a shape knows its distance, and that distance, exact."""
import array
import bisect
import math
import random
import sys


class Arc:
    """Of a circle in the half-plane (rho, z), rho >= 0; turned about z it makes a piece of a surface. outside: -1 in a fillet, where the solid does not have
    the centre."""

    def __init__(self, rho, z, radius, start, end, outside=1):
        self.rho, self.z, self.radius, self.start, self.end, self.outside = rho, z, radius, start, end, outside

    def areas(self, steps=2048):
        """Of the piece from the start to each of steps + 1 angles: the integral of 2 pi (rho + r cos a) r da."""
        angles = [self.start + (self.end - self.start) * i / steps for i in range(steps + 1)]
        return angles, [2 * math.pi * self.radius * (self.rho * (a - self.start) + self.radius * (math.sin(a) - math.sin(self.start))) for a in angles]


class Revolution:
    """A closed smooth profile of arcs, each tangent to the next, turned about z."""

    def __init__(self, name, genus, arcs):
        self.name, self.genus, self.arcs = name, genus, arcs
        self.angles, self.areas, self.of = [], [], []  # of all arcs, one after the other
        self.area = 0.0
        for arc in arcs:
            angles, areas = arc.areas()
            self.angles += angles
            self.areas += [self.area + area for area in areas]
            self.of += [arc] * len(angles)
            self.area = self.areas[-1]

    def point(self, source):
        wanted = source.random() * self.area
        i = min(max(bisect.bisect_right(self.areas, wanted), 1), len(self.areas) - 1)
        share = (wanted - self.areas[i - 1]) / max(self.areas[i] - self.areas[i - 1], 1e-300)
        arc, a = self.of[i], self.angles[i - 1] + share * (self.angles[i] - self.angles[i - 1])
        turn, rho = 2 * math.pi * source.random(), arc.rho + arc.radius * math.cos(a)
        return rho * math.cos(turn), rho * math.sin(turn), arc.z + arc.radius * math.sin(a)

    def distance(self, x, y, z):
        """Signed, positive outside. The foot is on the arc whose angles hold the direction from its centre; joints belong to both."""
        rho, best = math.hypot(x, y), math.inf
        for arc in self.arcs:
            a, b = rho - arc.rho, z - arc.z
            turn = (math.atan2(b, a) - arc.start) % (2 * math.pi)
            if turn <= arc.end - arc.start + 1e-9 or turn >= 2 * math.pi - 1e-9:
                found = arc.outside * (math.hypot(a, b) - arc.radius)
                best = found if abs(found) < abs(best) else best
        return best


def sphere():
    return Revolution("sphere", 0, [Arc(0, 0, 1, -math.pi / 2, math.pi / 2)])


def torus():
    return Revolution("torus", 1, [Arc(1, 0, 0.4, 0, 2 * math.pi)])


def blend():
    """Two spheres joined by a fillet, a piece of a torus that touches both."""
    first, second, apart, fillet = 1.0, 0.7, 1.5, 0.4
    z = ((first + fillet)**2 - (second + fillet)**2 + apart**2) / (2 * apart)
    rho = math.sqrt((first + fillet)**2 - z**2)
    return Revolution("blend", 0, [Arc(0, 0, first, -math.pi / 2, math.atan2(z, rho)),
                                   Arc(rho, z, fillet, math.atan2(apart - z, -rho), math.atan2(-z, -rho) + 2 * math.pi, -1),
                                   Arc(0, apart, second, math.atan2(z - apart, rho), math.pi / 2)])


class Box:
    """Edges and corners rounded by a ball of some radius, 0: sharp."""
    half = (1.0, 0.75, 0.5)

    def __init__(self, rounding, name="box"):
        self.name, self.genus, self.rounding = name, 0, rounding
        self.inner = [h - rounding for h in self.half]
        a, b, c = (2 * h for h in self.inner)
        faces = [(("face", 0), 2 * b * c), (("face", 1), 2 * a * c), (("face", 2), 2 * a * b)]
        edges = [(("edge", axis), 2 * math.pi * rounding * 2 * self.inner[axis]) for axis in range(3)]
        self.kinds, weights = zip(*faces, *edges, (("corner", 0), 4 * math.pi * rounding**2))
        self.areas = [sum(weights[:i + 1]) for i in range(len(weights))]
        self.area = self.areas[-1]

    def point(self, source):
        """A place of the inner box, and the ball's radius along one of its normals there."""
        kind, axis = self.kinds[min(bisect.bisect_right(self.areas, source.random() * self.area), len(self.kinds) - 1)]
        normal, is_free = [0.0, 0.0, 0.0], [False, False, False]
        if kind == "face":
            normal[axis] = source.choice((-1.0, 1.0))
            is_free = [other != axis for other in range(3)]
        elif kind == "edge":
            turn = 2 * math.pi * source.random()
            normal[(axis + 1) % 3], normal[(axis + 2) % 3] = math.cos(turn), math.sin(turn)
            is_free[axis] = True
        else:
            normal = direction(source)
        place = [source.uniform(-b, b) if free else math.copysign(b, n) for b, n, free in zip(self.inner, normal, is_free)]
        return tuple(p + self.rounding * n for p, n in zip(place, normal))

    def distance(self, x, y, z):
        out = [abs(p) - b for p, b in zip((x, y, z), self.inner)]
        return math.hypot(*(max(p, 0.0) for p in out)) + min(max(out), 0.0) - self.rounding

    def from_edge(self, x, y, z):
        """Of a point of the surface, to the nearest edge of the sharp box around it."""
        out = sorted(h - abs(p) for p, h in zip((x, y, z), self.half))
        return math.hypot(out[0], out[1])


def direction(source):
    z, turn = source.uniform(-1, 1), 2 * math.pi * source.random()
    rho = math.sqrt(1 - z * z)
    return rho * math.cos(turn), rho * math.sin(turn), z


class Bumpy:
    """A sphere whose radius goes up and down. No distance."""
    name, genus = "bumpy sphere", 0

    def point(self, source):
        x, y, z = direction(source)
        radius = 1 + 0.12 * math.sin(4 * x) * math.sin(5 * y + 1) * math.sin(3 * z + 2) + 0.03 * math.sin(11 * x + 7 * z) * math.sin(9 * y)
        return radius * x, radius * y, radius * z


class Knot:
    """A tube around a torus knot that winds twice about the axis. No distance."""
    name, genus, tube = "knot", 1, 0.4

    def point(self, source):
        t, turn = 2 * math.pi * source.random(), 2 * math.pi * source.random()
        rho, slope = 2 + math.cos(3 * t), -3 * math.sin(3 * t)
        c, s = math.cos(2 * t), math.sin(2 * t)
        along = (slope * c - 2 * rho * s, slope * s + 2 * rho * c, 3 * math.cos(3 * t))  # never upright: rho >= 1
        flat = math.hypot(along[0], along[1])
        length = math.hypot(flat, along[2])
        side = (along[1] / flat, -along[0] / flat, 0.0)
        up = (-along[0] * along[2] / (flat * length), -along[1] * along[2] / (flat * length), flat / length)
        a, b = self.tube * math.cos(turn), self.tube * math.sin(turn)
        return rho * c + a * side[0] + b * up[0], rho * s + a * side[1] + b * up[1], math.sin(3 * t) + a * side[2] + b * up[2]


# ---------------------------------------------------------------- clouds: arrays x y z, x y z, ..

def cloud(shape, count, seed=1, kind="d"):
    source, out = random.Random(seed), array.array(kind)
    for _ in range(count):
        out.extend(shape.point(source))
    return out


def diagonal(points):
    return math.hypot(*(max(points[axis::3]) - min(points[axis::3]) for axis in range(3)))


def noisy(points, sigma, seed=2):
    """Normal noise of every coordinate, model units."""
    source = random.Random(seed)
    return array.array(points.typecode, (p + source.gauss(0, sigma) for p in points)) if sigma > 0 else points


def triples(points):
    return zip(points[0::3], points[1::3], points[2::3])


def write_ply(path, points):
    """Points alone, binary."""
    properties = "".join(f"property { {'d': 'double', 'f': 'float'}[points.typecode]} {axis}\n" for axis in "xyz")
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_{sys.byteorder}_endian 1.0\nelement vertex {len(points) // 3}\n{properties}end_header\n".encode())
        points.tofile(file)


def read_ply(path):
    """The vertices of a binary PLY of this machine's byte order that have x, y, z in double and nothing else, as limitcl writes them."""
    with open(path, "rb") as file:
        head = [file.readline().decode().strip()]
        while head[-1] != "end_header":
            head.append(file.readline().decode().strip())
        first = next(i for i, line in enumerate(head) if line.startswith("element vertex"))
        if f"format binary_{sys.byteorder}_endian 1.0" not in head or head[first + 1:first + 4] != [f"property double {a}" for a in "xyz"] \
                or head[first + 4].startswith("property"):
            raise RuntimeError(f"{path}: not the PLY that was expected: {head}")
        points = array.array("d")
        points.fromfile(file, 3 * int(head[first].split()[-1]))
        return points
