"""Walls of a DXF drawing, for rubble.import_plan. Needs the package ezdxf."""
import math

if __package__:
    from .plan_lines import FARTHEST, LEAST, PlanError, line
else:  # the file beside this one, where import_plan.py is run by its path
    from plan_lines import FARTHEST, LEAST, PlanError, line  # type: ignore[import-not-found,no-redef,unused-ignore]

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "in": 0.0254}


class DxfReader:
    """Walls as axes, as two parallel faces, or as thin closed rectangles."""

    def __init__(self, path, plan, options):
        try:
            import ezdxf  # type: ignore[import-not-found,unused-ignore]
            import ezdxf.units  # type: ignore[import-not-found,unused-ignore]
        except ImportError as error:
            raise PlanError(f"{path}: needs the package ezdxf: pip install ezdxf ({error})") from error
        self.path, self.plan, self.options = path, plan, options
        try:
            self.drawing = ezdxf.readfile(path)
        except (IOError, ezdxf.DXFError, ValueError, KeyError, TypeError, AttributeError, IndexError) as error:
            raise PlanError(f"{path}: cannot be read as DXF: {error}") from error
        units = self.drawing.header.get("$INSUNITS", 0)
        if options.unit:
            self.scale = UNITS[options.unit]
        elif not units:
            raise PlanError(f"{path}: does not state its unit ($INSUNITS): give --unit {', '.join(UNITS)}")
        else:
            try:
                self.scale = ezdxf.units.conversion_factor(units, ezdxf.units.M)
            except Exception as error:
                raise PlanError(f"{path}: $INSUNITS is {units}, which is no unit of length: give --unit {', '.join(UNITS)}") from error

    def is_wall(self, layer):
        if self.options.layer:
            return layer in self.options.layer
        return any(word in layer.lower() for word in ("wall", "wand", "mauer", "mur", "pared", "parete"))

    def lines(self):
        """Two points and the entity, of every straight line on the layers of walls."""
        layers, others = set(), {}
        for entity in self.drawing.modelspace():
            kind, layer, what = entity.dxftype(), entity.dxf.layer, f"{entity.dxftype()} #{entity.dxf.handle} on layer {entity.dxf.layer}"
            layers.add(layer)
            self.plan.place = what
            if not self.is_wall(layer):
                continue
            if kind == "LINE":
                yield [entity.dxf.start, entity.dxf.end], False, what
            elif kind == "LWPOLYLINE":
                if any(abs(bulge) > 1e-9 for *_, bulge in entity.get_points()):
                    raise PlanError(f"{self.path}: {what}: has arcs: expected straight lines")
                yield list(entity.vertices()), entity.closed, what
            elif kind == "POLYLINE":
                yield [v.dxf.location for v in entity.vertices], entity.is_closed, what
            else:
                others[kind] = others.get(kind, 0) + 1
        for kind, count in sorted(others.items()):
            self.plan.notes.append(f"{count} {kind} on layers of walls: expected LINE, LWPOLYLINE and POLYLINE")
        if not any(self.is_wall(layer) for layer in layers):
            raise PlanError(f"{self.path}: no layer of walls: give --layer, one of {', '.join(sorted(layers)) or 'none: the file draws nothing'}")

    def read(self):
        thickness = self.options.thickness
        walls, faces = [], []
        for points, closed, what in self.lines():
            points = [self.plan.turned(p[0] * self.scale, p[1] * self.scale) for p in points]
            if not all(abs(x) < FARTHEST for point in points for x in point):
                raise PlanError(f"{self.path}: {what}: has a corner that is not within {FARTHEST:g} m: is the unit right?")
            if closed and len(points) == 4 and thickness is None:
                wall = self.rectangle(points)
                if wall:
                    walls.append((*wall, what))
                    continue
            for a, b in zip(points, points[1:] + (points[:1] if closed else [])):
                if math.dist(a, b) < LEAST:
                    continue
                (faces if thickness is None else walls).append((a, b, what) if thickness is None else (a, b, thickness, what))
        walls += self.pairs(faces)
        for storey in range(self.options.storeys):
            self.plan.heights.append(self.options.height)
            for a, b, thick, what in walls:
                self.plan.wall(storey, a, b, thick, self.options.material, "", what)
            if self.options.slab:
                xs, ys = [p[0] for w in walls for p in w[:2]], [p[1] for w in walls for p in w[:2]]
                if walls:
                    self.plan.add(storey, line("slab", *map(float, (min(xs), min(ys), max(xs), max(ys), self.options.slab)), "concrete"))

    def rectangle(self, p):
        """Axis and thickness of a rectangle whose sides are a wall's."""
        sides = [math.dist(p[i], p[(i + 1) % 4]) for i in range(4)]
        if abs(sides[0] - sides[2]) > 1e-3 or abs(sides[1] - sides[3]) > 1e-3 or min(sides) > self.options.thickest:
            return None
        if sides[0] < sides[1]:
            p, sides = p[1:] + p[:1], sides[1:] + sides[:1]

        def middle(a, b):
            return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2
        return middle(p[0], p[3]), middle(p[1], p[2]), sides[1]

    def pairs(self, faces):
        """Axes between faces that lie opposite each other. Each face is taken where its nearest opposite is."""
        flat = []  # (along X?, place across, low, high, what)
        for a, b, what in faces:
            along_x = self.plan.is_along_x(a, b, what)
            i = 0 if along_x else 1
            flat.append((along_x, (a[1 - i] + b[1 - i]) / 2, min(a[i], b[i]), max(a[i], b[i]), what))
        walls, covered = [], {}
        candidates = []
        for m, one in enumerate(flat):
            for n in range(m + 1, len(flat)):
                other = flat[n]
                low, high, gap = max(one[2], other[2]), min(one[3], other[3]), abs(one[1] - other[1])
                if one[0] == other[0] and high - low > LEAST and LEAST < gap <= self.options.thickest:
                    candidates.append((gap, m, n, low, high))
        for gap, m, n, low, high in sorted(candidates):
            taken = covered.get(m, []) + covered.get(n, [])
            if any(min(high, b) - max(low, a) > LEAST for a, b in taken):
                continue
            covered.setdefault(m, []).append((low, high))
            covered.setdefault(n, []).append((low, high))
            across, what = (flat[m][1] + flat[n][1]) / 2, flat[m][4]
            ends = ((low, across), (high, across)) if flat[m][0] else ((across, low), (across, high))
            walls.append((*ends, gap, what))
        alone = [face for i, face in enumerate(flat) if i not in covered and face[3] - face[2] > self.options.thickest]
        if alone:
            _, across, low, high, what = alone[0]
            raise PlanError(f"{self.path}: {what}: the face from {low:.3f} to {high:.3f} at {across:.3f} m has no other within "
                            f"{self.options.thickest} m: draw both faces, or give --thickness if lines are axes")
        return walls
