#!/usr/bin/env python3
"""Writes a building of IFC or walls of DXF as a plan for rubble.read_plan: python -m rubble.import_plan house.ifc -o house.txt

IFC needs the package ifcopenshell, DXF ezdxf; both come by pip. Plans have walls along X and Y: --turn turns a building
that stands otherwise. What is left out is printed. Exit code 1: a file or an entity that cannot be taken, named.
"""
import argparse
import math
import sys

STRAIGHT = 0.01      # of a direction from an axis; unit: rad
LEAST = 0.01         # of a part's sides; unit: m
FARTHEST = 1e5      # of a part from the origin; unit: m
MOST_STOREYS = 12
WORDS = {"concrete": ("concrete", "beton", "béton", "hormig"), "block": ("block", "aac", "ytong", "porenbeton"),
         "timber": ("timber", "wood", "holz", "bois", "madera"),
         "brick": ("brick", "masonry", "ziegel", "mauerwerk", "brique", "ladrillo")}


class PlanError(Exception):
    """What is wrong, with the file and the entity."""


def number(value):
    """Metres to the millimetre, without zeros at the end."""
    if not abs(value) < FARTHEST:
        raise ValueError(f"{value} m: expected a number of metres within {FARTHEST:g}")
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def line(kind, *words):
    return " ".join([kind] + [number(word) if isinstance(word, float) else str(word) for word in words])


def material_of(text):
    text = text.lower()
    return next((material for material, words in WORDS.items() if any(word in text for word in words)), "")


def plain(name):
    """A name as one word of a plan."""
    return "".join(letter if letter.isascii() and (letter.isalnum() or letter in "_-.") else "_" for letter in name or "")


class Plan:
    """Lines by storey; what is left out. place: the entity that is read, for messages."""

    def __init__(self, path, turn):
        self.path, self.heights, self.lines, self.notes, self.place = path, [], {}, [], ""
        self.cos, self.sin = math.cos(math.radians(turn)), math.sin(math.radians(turn))

    def add(self, storey, text):
        self.lines.setdefault(storey, []).append(text)

    def turned(self, x, y):
        return self.cos * x - self.sin * y, self.sin * x + self.cos * y

    def is_along_x(self, a, b, what):
        """Of a direction in the plan; an error that names the entity where it is along neither axis."""
        if not all(abs(x) < FARTHEST for x in (*a[:2], *b[:2])):
            raise PlanError(f"{self.path}: {what}: lies at {a[0]:g}, {a[1]:g} and {b[0]:g}, {b[1]:g} m: expected numbers within {FARTHEST:g}")
        angle = math.atan2(b[1] - a[1], b[0] - a[0])
        quarter = round(angle / (math.pi / 2))
        rest = angle - quarter * math.pi / 2
        if abs(rest) > STRAIGHT:
            raise PlanError(f"{self.path}: {what}: is turned by {math.degrees(rest):.2f} degrees: expected along X or Y; "
                            f"--turn {-math.degrees(rest):.4f} turns the building")
        return quarter % 2 == 0

    def wall(self, storey, a, b, thickness, material, name, what):
        """On the axis from a to b, which is made exactly straight."""
        if math.dist(a, b) < LEAST or thickness < LEAST:
            raise PlanError(f"{self.path}: {what}: is {math.dist(a, b):.3f} m long and {thickness:.3f} m thick: expected {LEAST} m or more")
        along_x = self.is_along_x(a, b, what)
        if along_x:
            b = (b[0], (a[1] + b[1]) / 2)
            a = (a[0], b[1])
        else:
            b = ((a[0] + b[0]) / 2, b[1])
            a = (b[0], a[1])
        words = [word for word in (material, "name=" + name if name else "") if word]
        self.add(storey, line("wall", *map(float, (*a, *b, thickness)), *words))
        return along_x

    def text(self):
        if not any(part.startswith("wall") or part.startswith("column") for lines in self.lines.values() for part in lines):
            raise PlanError(f"{self.path}: has no wall and no column")
        if not 0 < len(self.heights) <= MOST_STOREYS:
            raise PlanError(f"{self.path}: has {len(self.heights)} storeys: expected 1 to {MOST_STOREYS}")
        for storey, height in enumerate(self.heights):
            if not LEAST <= height < FARTHEST:
                raise PlanError(f"{self.path}: storey {storey} is {height:.3f} m high: expected {LEAST} m or more")
        text = [f"# From {plain(self.path.rsplit('/', 1)[-1])} by rubble.import_plan; lengths in metres."]
        text += [line("storey", float(height)) for height in self.heights]
        for storey in sorted(self.lines):
            text += [line("storeys", storey, storey)] + self.lines[storey]
        return "\n".join(text) + "\n"


# --- IFC ---------------------------------------------------------------------------------------------------------

class IfcReader:
    """Walls, openings, columns, beams and slabs by their shapes."""

    def __init__(self, path, plan):
        try:
            import ifcopenshell  # type: ignore[import-not-found,unused-ignore]
            import ifcopenshell.geom  # type: ignore[import-not-found,unused-ignore]
            import ifcopenshell.util.element  # type: ignore[import-not-found,unused-ignore]
            import ifcopenshell.util.unit  # type: ignore[import-not-found,unused-ignore]
        except ImportError as error:
            raise PlanError(f"{path}: needs the package ifcopenshell: pip install ifcopenshell ({error})") from error
        self.ifc, self.path, self.plan = ifcopenshell, path, plan
        with open(path, "rb") as opened:
            if not opened.read(64).lstrip().startswith(b"ISO-10303-21"):
                raise PlanError(f"{path}:1: is no IFC file: expected ISO-10303-21 (STEP text); ifcXML and ifcZIP are not read")
        try:
            self.model = ifcopenshell.open(path)
            self.scale = ifcopenshell.util.unit.calculate_unit_scale(self.model)
        except Exception as error:
            raise PlanError(f"{path}: cannot be read as IFC: {error}") from error
        self.settings = ifcopenshell.geom.settings()
        self.settings.set("disable-opening-subtractions", True)

    def what(self, entity):
        return f"#{entity.id()} {entity.is_a()} {entity.Name or ''}".rstrip()

    def box(self, entity):
        """Corners in the entity's own frame (unit: m), and that frame in the world."""
        self.plan.place = self.what(entity)
        try:
            shape = self.ifc.geom.create_shape(self.settings, entity)
        except Exception as error:
            raise PlanError(f"{self.path}: {self.what(entity)}: has no shape: {str(error).strip()}") from error
        flat, m = shape.geometry.verts, shape.transformation.matrix
        points = [flat[i:i + 3] for i in range(0, len(flat), 3)]
        if not points:
            raise PlanError(f"{self.path}: {self.what(entity)}: has no shape")
        low, high = [min(p[i] for p in points) for i in range(3)], [max(p[i] for p in points) for i in range(3)]
        columns = [m[i:i + 3] for i in range(0, 16, 4)]  # column by column

        def to_world(p):
            x, y, z = (sum(columns[k][i] * p[k] for k in range(3)) + columns[3][i] for i in range(3))
            return (*self.plan.turned(x, y), z)
        if abs(columns[2][2]) < 1 - STRAIGHT:
            raise PlanError(f"{self.path}: {self.what(entity)}: leans: expected a part that stands upright")
        return low, high, to_world

    def material(self, entity):
        found = self.ifc.util.element.get_material(entity)
        names = [getattr(m, "Name", "") or "" for m in self.ifc.util.element.get_materials(entity)] if found else []
        return material_of(" ".join(names + [entity.Name or ""]))

    def read(self):
        # Storeys by their floors. A level where nothing stands, such as that of a roof, ends the one below.
        levels = sorted((((s.Elevation or 0.0) * self.scale, s) for s in self.model.by_type("IfcBuildingStorey")), key=lambda level: level[0])
        if not levels:
            raise PlanError(f"{self.path}: has no IfcBuildingStorey")
        standing, walls = {}, []
        for entity in self.model.by_type("IfcWall") + self.model.by_type("IfcColumn") + self.model.by_type("IfcBeam") + self.model.by_type("IfcSlab"):
            self.plan.place = self.what(entity)
            storey = self.ifc.util.element.get_container(entity, ifc_class="IfcBuildingStorey")
            if storey is None:
                self.plan.notes.append(f"{self.what(entity)}: is in no storey")
                continue
            if entity.is_a("IfcSlab"):
                continue
            box = self.box(entity)
            standing[storey.id()] = max(standing.get(storey.id(), 0), box[2](box[1])[2])
            walls.append((entity, storey.id(), box))
        floors = [(elevation, s.id()) for elevation, s in levels if s.id() in standing]
        if not floors:
            raise PlanError(f"{self.path}: no storey has a wall, a column or a beam")
        tops = [elevation for elevation, _ in floors[1:]] + [0.0]
        last = floors[-1]
        above = [elevation for elevation, _ in levels if elevation > last[0] + 1]
        tops[-1] = above[0] if above else standing[last[1]]
        self.plan.heights = [top - floor for (floor, _), top in zip(floors, tops)]
        storeys = {ident: i for i, (_, ident) in enumerate(floors)}
        for entity, storey, box in walls:
            self.add(entity, storeys[storey], box, floors[storeys[storey]][0])
        for slab in self.model.by_type("IfcSlab"):
            self.add_slab(slab, floors, tops)
        for kind in ("IfcStair", "IfcRoof", "IfcCurtainWall", "IfcRailing", "IfcMember", "IfcPlate"):
            count = len(self.model.by_type(kind))
            if count:
                self.plan.notes.append(f"{count} {kind}: plans have no such part")

    def add(self, entity, storey, box, floor):
        low, high, to_world = box
        self.plan.place = self.what(entity)
        what, material, name = self.what(entity), self.material(entity), plain(entity.Name)
        middle, half = [(a + b) / 2 for a, b in zip(low, high)], [(b - a) / 2 for a, b in zip(low, high)]
        if entity.is_a("IfcColumn"):
            a, b = to_world((low[0], low[1], 0)), to_world((high[0], high[1], 0))
            self.plan.is_along_x(to_world((low[0], middle[1], 0)), to_world((high[0], middle[1], 0)), what)
            words = [material] if material else []
            self.plan.add(storey, line("column", (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, abs(a[0] - b[0]), abs(a[1] - b[1]), *words))
            return
        along = 0 if half[0] >= half[1] else 1
        ends = [list(middle), list(middle)]
        ends[0][along], ends[1][along] = low[along], high[along]
        a, b = to_world(ends[0]), to_world(ends[1])
        thickness = 2 * half[1 - along]
        if entity.is_a("IfcBeam"):
            self.plan.is_along_x(a, b, what)
            words = [material] if material else []
            self.plan.add(storey, line("beam", a[0], a[1], b[0], b[1], thickness, 2 * half[2], *words))
            return
        along_x = self.plan.wall(storey, a[:2], b[:2], thickness, material, name, what)
        for relation in entity.HasOpenings:
            if relation.RelatedOpeningElement is None:
                raise PlanError(f"{self.path}: {what}: its #{relation.id()} {relation.is_a()} names no opening")
            self.add_opening(relation.RelatedOpeningElement, storey, (a, b), along_x, floor)

    def add_opening(self, opening, storey, wall, along_x, floor):
        low, high, to_world = self.box(opening)
        corners = [to_world((x, y, z)) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        i = 0 if along_x else 1
        ends = sorted(point[i] for point in wall)
        first, last = max(min(c[i] for c in corners), ends[0]), min(max(c[i] for c in corners), ends[1])
        sill, head = min(c[2] for c in corners) - floor, max(c[2] for c in corners) - floor
        if last - first < LEAST:
            self.plan.notes.append(f"{self.what(opening)}: lies beside its wall")
            return
        axis = wall[0][1 - i]
        place = [first, axis, last, axis] if along_x else [axis, first, axis, last]
        head = min(head, self.plan.heights[storey])
        if sill < 0.05:
            self.plan.add(storey, line("door", *map(float, place), head))
        else:
            self.plan.add(storey, line("window", *map(float, place), sill, head))

    def add_slab(self, slab, floors, tops):
        low, high, to_world = self.box(slab)
        a, b = to_world(low), to_world(high)
        self.plan.is_along_x(to_world((low[0], low[1], 0)), to_world((high[0], low[1], 0)), self.what(slab))
        upper = max(a[2], b[2])
        # Its upper side is the next floor. What lies under the lowest storey is the ground.
        nearest = min(range(len(tops)), key=lambda i: abs(tops[i] - upper))
        if abs(upper - floors[0][0]) < abs(tops[nearest] - upper):
            self.plan.notes.append(f"{self.what(slab)}: lies on the ground")
            return
        words = ["concrete" if self.material(slab) != "timber" else "timber"]
        self.plan.add(nearest, line("slab", min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1]), high[2] - low[2], *words))


# --- DXF ---------------------------------------------------------------------------------------------------------

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


def parse(arguments):
    parser = argparse.ArgumentParser(prog="rubble.import_plan", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("file", help="an IFC file (.ifc) or a drawing (.dxf)")
    parser.add_argument("-o", "--out", help="the plan; default: standard output")
    parser.add_argument("--turn", type=float, default=0, help="degrees by which the building is turned, counter-clockwise")
    dxf = parser.add_argument_group("DXF")
    dxf.add_argument("--layer", action="append", help="a layer with walls; default: those with `wall` in their names")
    dxf.add_argument("--unit", choices=UNITS, help="of the drawing, where it does not state one")
    dxf.add_argument("--thickness", type=float, help="lines are axes of walls of this thickness (m); default: lines are faces")
    dxf.add_argument("--thickest", type=float, default=0.65, help="largest distance of two faces of a wall (m); default: 0.65")
    dxf.add_argument("--height", type=float, default=3.0, help="of a storey (m); default: 3")
    dxf.add_argument("--storeys", type=int, default=1, help="that are alike; default: 1")
    dxf.add_argument("--slab", type=float, default=0.0, help="thickness of a concrete floor over each storey (m); default: none")
    dxf.add_argument("--material", choices=["concrete", "brick", "block", "timber"], default="brick", help="default: brick")
    return parser.parse_args(arguments)


def main(arguments=None):
    try:
        options = parse(arguments)
    except SystemExit as end:  # 2, that of argparse, is another code in all other commands
        return 1 if end.code else 0
    plan = Plan(options.file, options.turn)
    try:
        if options.file.lower().endswith(".dxf"):
            DxfReader(options.file, plan, options).read()
        elif options.file.lower().endswith(".ifc"):
            IfcReader(options.file, plan).read()
        else:
            raise PlanError(f"{options.file}: expected .ifc or .dxf; export DWG as DXF")
        text = plan.text()
        if options.out:
            with open(options.out, "w", encoding="ascii") as out:
                out.write(text)
        else:
            sys.stdout.write(text)
    except (PlanError, OSError) as error:
        print(f"rubble.import_plan: {error}", file=sys.stderr)
        return 1
    except Exception as error:  # of a reader that trusts its file
        place = f"{options.file}: {plan.place}: " if plan.place else f"{options.file}: "
        print(f"rubble.import_plan: {place}cannot be taken: {type(error).__name__}: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    for note in plan.notes:
        print(f"{options.file}: left out: {note}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
