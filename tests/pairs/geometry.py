"""Rotations, lenses and rays in numpy: what the judges reckon with, from the formulas of the documents."""
import struct

import numpy as np

# Body axes (X forward, Y left, Z up) of the optical frame (Z forward, X right, Y down).
BODY_FROM_OPTICAL = np.array([[0.0, 0, 1], [-1, 0, 0], [0, -1, 0]])


def matrix(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def rpy_matrix(degrees):
    r, p, y = np.radians(degrees)
    return (np.array([[np.cos(y), -np.sin(y), 0], [np.sin(y), np.cos(y), 0], [0, 0, 1]]) @
            np.array([[np.cos(p), 0, np.sin(p)], [0, 1, 0], [-np.sin(p), 0, np.cos(p)]]) @
            np.array([[1, 0, 0], [0, np.cos(r), -np.sin(r)], [0, np.sin(r), np.cos(r)]]))


def turn(vector):
    """The rotation by a vector (Rodrigues)."""
    angle = np.linalg.norm(vector)
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = np.asarray(vector) / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def angle_between(a, b):
    return float(np.arccos(np.clip((np.trace(a.T @ b) - 1) / 2, -1, 1)))


def project(points, k, lens, coefficients):
    """Pixels of points in the optical frame (n, 3); NaN behind the camera."""
    points = np.asarray(points, float)
    with np.errstate(all="ignore"):
        if lens in ("equidistant", "fisheye"):
            radius = np.hypot(points[:, 0], points[:, 1])
            angle = np.arctan2(radius, points[:, 2])
            k1, k2, k3, k4 = (list(coefficients) + [0] * 4)[:4]
            bent = angle * (1 + k1 * angle**2 + k2 * angle**4 + k3 * angle**6 + k4 * angle**8)
            scale = np.where(radius > 1e-12, bent / np.maximum(radius, 1e-12), 1)
            x, y = points[:, 0] * scale, points[:, 1] * scale
        else:
            x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
            k1, k2, p1, p2, k3 = (list(coefficients) + [0] * 5)[:5]
            r2 = x * x + y * y
            radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
            x, y = (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y)
            x = np.where(points[:, 2] > 0, x, np.nan)
    return np.stack([k[0] * x + k[2], k[4] * y + k[5]], axis=1)


def ray_of_pixel(pixel, k, lens, coefficients):
    """Unit ray in the optical frame whose projection is the pixel, by iteration; None where there is none."""
    wanted = np.array([(pixel[0] - k[2]) / k[0], (pixel[1] - k[5]) / k[4]])
    if lens in ("equidistant", "fisheye"):
        bent = np.hypot(*wanted)
        angle = bent
        k1, k2, k3, k4 = (list(coefficients) + [0] * 4)[:4]
        for _ in range(30):
            angle = bent / (1 + k1 * angle**2 + k2 * angle**4 + k3 * angle**6 + k4 * angle**8)
        direction = wanted / bent if bent > 1e-12 else np.zeros(2)
        return np.array([*(np.sin(angle) * direction), np.cos(angle)])
    at = wanted.copy()
    for _ in range(30):
        found = project(np.array([[at[0], at[1], 1.0]]), k, lens, coefficients)[0]
        at += wanted - [(found[0] - k[2]) / k[0], (found[1] - k[5]) / k[4]]
    ray = np.array([at[0], at[1], 1.0])
    return ray / np.linalg.norm(ray)


def read_ply(path):
    """Vertices, piece of each vertex, triangles, of a pile.ply."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + 11
    head = data[:end].decode("ascii").splitlines()
    counts = [int(line.split()[2]) for line in head if line.startswith("element")]
    sizes = {"float": "<f4", "uchar": "u1", "int": "<i4", "uint": "<u4", "double": "<f8"}
    fields = [(line.split()[2], sizes[line.split()[1]]) for line in head
              if line.startswith("property") and "list" not in line]
    vertices = np.frombuffer(data, np.dtype(fields), counts[0], end)
    faces = np.frombuffer(data, np.dtype([("count", "u1"), ("corners", "<i4", 3)]), counts[1], end + vertices.nbytes)
    if len(faces) and (faces["count"] != 3).any():
        raise ValueError(path + " has faces that are no triangles")
    if end + vertices.nbytes + faces.nbytes != len(data):
        raise ValueError(path + " has another length than its head says")
    points = np.stack([vertices[axis].astype(float) for axis in "xyz"], axis=1)
    return points, vertices["piece"].astype(int), faces["corners"]


def read_stl(path):
    """Triangles (n, 3, 3) of a binary STL file."""
    with open(path, "rb") as file:
        data = file.read()
    count, = struct.unpack_from("<I", data, 80)
    if len(data) != 84 + 50 * count:
        raise ValueError(path + " has another length than it says")
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    return np.frombuffer(data, record, count, 84)["corners"].astype(float)


class Solid:
    """Triangles in groups with spheres about them, and the plane z = 0."""

    def __init__(self, points, group_of_point, triangles):
        corners = points[triangles]
        group = group_of_point[triangles[:, 0]]
        order = np.argsort(group, kind="stable")
        self.corners, self.group = corners[order], group[order]
        self.names, starts = np.unique(self.group, return_index=True)
        self.parts = np.split(self.corners, starts[1:]) if len(starts) else []
        self.centres = np.array([part.reshape(-1, 3).mean(axis=0) for part in self.parts]).reshape(-1, 3)
        self.radii = np.array([np.linalg.norm(part.reshape(-1, 3) - centre, axis=1).max()
                               for part, centre in zip(self.parts, self.centres)])

    def cast(self, origin, direction):
        """Distance along a unit ray to the nearest surface, and its group (-1: ground); inf, -2 where there is none."""
        best, name = np.inf, -2
        if direction[2] < -1e-9 and origin[2] > 0:
            best, name = -origin[2] / direction[2], -1
        if not self.parts:
            return best, name
        to = self.centres - origin
        along = to @ direction
        beside = np.linalg.norm(to - along[:, None] * direction, axis=1)
        for i in np.flatnonzero((beside <= self.radii) & (along > -self.radii)):
            if along[i] - self.radii[i] < best:
                distance = nearest(self.parts[i], origin, direction)
                if distance < best:
                    best, name = distance, int(self.names[i])
        return best, name


def nearest(corners, origin, direction):
    """Möller and Trumbore's test, on both sides of a triangle."""
    a = corners[:, 0]
    e1, e2 = corners[:, 1] - a, corners[:, 2] - a
    p = np.cross(direction, e2)
    scale = np.einsum("ij,ij->i", e1, p)
    with np.errstate(all="ignore"):
        inverse = 1 / scale
        s = origin - a
        u = np.einsum("ij,ij->i", s, p) * inverse
        q = np.cross(s, e1)
        v = q @ direction * inverse
        t = np.einsum("ij,ij->i", e2, q) * inverse
        hit = (np.abs(scale) > 1e-14) & (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (t > 1e-6)
    return t[hit].min() if hit.any() else np.inf
