"""What the readers of rubble.import_pack make: assets, their surfaces, and notes on what is left out."""


class PackError(Exception):
    """What is wrong, with the file and the mesh."""


class Look:
    """Of a surface. picture, bumps: a file's ending and bytes; None: none. placed: scale and offset of the picture's coordinates."""

    def __init__(self, colour=None, picture=None, bumps=None, metal=None, roughness=None, placed=None):
        self.colour, self.picture, self.bumps, self.metal, self.roughness, self.placed = colour, picture, bumps, metal, roughness, placed

    def key(self):
        return (self.colour, self.picture, self.bumps, self.metal, self.roughness, self.placed)


class Asset:
    """vertices in metres. corners: of each corner of each face in turn a place on the picture; empty: none. look_of: of each face."""

    def __init__(self, name, vertices, faces, looks, look_of, corners=()):
        self.name, self.vertices, self.faces, self.looks, self.look_of, self.corners = name, vertices, faces, looks, look_of, corners
        self.density = None  # unit: kg/m3
        self.mass = None     # instead, of this and what shares it; unit: kg
        self.shares = None   # with whom: the name of a body

    def key(self):
        return (tuple(self.vertices), tuple(map(tuple, self.faces)), tuple(look.key() for look in self.looks), tuple(self.look_of),
                tuple(self.corners), self.density and float(f"{self.density:.6g}"))


def volume(vertices, faces):
    """Of a closed mesh, by the tetrahedra of its triangles and the origin."""
    total = 0.0
    for face in faces:
        for i in range(1, len(face) - 1):
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (vertices[face[k]] for k in (0, i, i + 1))
            total += (ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx)) / 6
    return abs(total)


class Notes:
    """What is left out, each once; kinds of things ("a sphere: ...") with their number."""

    def __init__(self):
        self.counts = {}

    def add(self, text):
        self.counts[text] = self.counts.get(text, 0) + 1

    def lines(self):
        return [f"{text} ({count} times)" if count > 1 and text.startswith("a ") else text for text, count in self.counts.items()]
