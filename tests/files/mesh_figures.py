"""What trimesh says of a mesh: size, faces, closedness, volume."""
import functools
import warnings
from pathlib import Path

import numpy
import trimesh
from scipy.spatial import ConvexHull, QhullError

CRACK = 1e-4  # of a mesh's size: corners nearer than this are one for programs that mend what rounding tore

SUFFIXES = (".obj", ".stl", ".dae", ".ply", ".glb", ".gltf")


class Mesh:
    def __init__(self, path):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            loaded = trimesh.load_scene(str(path), process=False, skip_materials=True)
        unit = 1.0
        if Path(path).suffix.lower() == ".dae":  # trimesh leaves the unit to its caller
            import collada
            unit = collada.Collada(str(path), ignore=[Exception]).assetInfo.unitmeter or 1.0
        parts = []
        for part in loaded.dump():
            if isinstance(part, trimesh.Trimesh) and len(part.faces):
                parts.append(part)
        if not parts:
            raise ValueError("no triangles")
        self.mesh = trimesh.util.concatenate([trimesh.Trimesh(p.vertices, p.faces, process=False) for p in parts])
        self.mesh.apply_scale(unit)
        used = self.mesh.vertices[numpy.unique(self.mesh.faces)]
        self.bounding_points = used
        if len(used) > 3000:  # a hull has the same bounds in every frame
            try:
                self.bounding_points = used[ConvexHull(used).vertices]
            except QhullError:  # a flat mesh
                pass

    def is_closed_but_for_cracks(self):
        places = self.mesh.vertices / (CRACK * numpy.ptp(self.mesh.vertices, axis=0).max())
        _, merged = numpy.unique(numpy.round(places).astype(numpy.int64), axis=0, return_inverse=True)
        return edges_of(merged.ravel()[self.mesh.faces])[0]

    def figures(self):
        used = self.bounding_points
        size = used.max(axis=0) - used.min(axis=0)
        if not numpy.isfinite(size).all():
            raise ValueError("corners that are not finite")
        figures = {"size_m": [float(f"{v:.6g}") for v in size], "faces": int(len(self.mesh.faces))}
        spread = numpy.linalg.svd(used - used.mean(axis=0), compute_uv=False)
        if len(spread) < 3 or spread[2] < 1e-9 * spread[0]:
            figures["flat"] = True  # no solid
        merged = self.mesh.copy()
        merged.merge_vertices(merge_tex=True, merge_norm=True)
        balanced, paired = edges_of(merged.faces)
        if paired and not balanced:  # triangles that face both ways are turned, with a note
            trimesh.repair.fix_normals(merged)
            balanced, paired = edges_of(merged.faces)
            if balanced:
                figures["turned"] = True
        # In between, programs differ: four faces meet in an edge, or cracks of rounding run between the faces.
        if paired or not balanced and not self.is_closed_but_for_cracks():
            figures["closed"] = balanced
        if balanced:
            figures["volume_m3"] = float(f"{abs(merged.volume):.6g}")
        return figures


def edges_of(faces):
    """Whether every edge is passed as often one way as the other, and whether every edge has two faces."""
    a, b, c = faces.T
    whole = faces[(a != b) & (b != c) & (c != a)]
    edges = numpy.vstack([whole[:, [0, 1]], whole[:, [1, 2]], whole[:, [2, 0]]])
    _, group = numpy.unique(numpy.sort(edges, axis=1), axis=0, return_inverse=True)
    turns = numpy.where(edges[:, 0] < edges[:, 1], 1, -1)
    return not numpy.bincount(group.ravel(), weights=turns).any(), bool((numpy.bincount(group.ravel()) == 2).all())


@functools.lru_cache(maxsize=64)
def load_mesh(path):
    return Mesh(path)
