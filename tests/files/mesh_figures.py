"""What trimesh says of a mesh: size, faces, closedness, volume."""
import functools
import warnings
from pathlib import Path

import numpy
import trimesh
from scipy.spatial import ConvexHull, QhullError

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

    def figures(self):
        used = self.bounding_points
        low, high = used.min(axis=0), used.max(axis=0)
        if not numpy.isfinite(high - low).all():
            raise ValueError("corners that are not finite")
        merged = self.mesh.copy()
        merged.merge_vertices(merge_tex=True, merge_norm=True)
        merged.update_faces(merged.nondegenerate_faces(height=0))
        closed = bool(merged.is_watertight and merged.is_winding_consistent)
        figures = {"size_m": [float(f"{v:.6g}") for v in high - low], "faces": int(len(self.mesh.faces)),
                   "closed": closed}
        if closed:
            figures["volume_m3"] = float(f"{abs(merged.volume):.6g}")
        return figures


@functools.lru_cache(maxsize=64)
def load_mesh(path):
    return Mesh(path)
