"""Buildings of IFC, for rubble.import_plan. Needs the package ifcopenshell."""
import math

if __package__:
    from .import_asset import volume
    from .plan_lines import LEAST, STRAIGHT, PlanError, line, plain
else:  # the files beside this one, where import_plan.py is run by its path
    from import_asset import volume  # type: ignore[import-not-found,no-redef,unused-ignore]
    from plan_lines import LEAST, STRAIGHT, PlanError, line, plain  # type: ignore[import-not-found,no-redef,unused-ignore]

FULL = 0.97          # share of its box that a part fills, or its shape is left out
BELOW_FLOOR = 0.4    # from the level of a floor to the top of what carries it, and to the slab itself; unit: m
TAKEN = ("IfcWall", "IfcColumn", "IfcBeam", "IfcSlab", "IfcFeatureElement")
WORDS = {"concrete": ("concrete", "beton", "béton", "hormig"), "block": ("block", "aac", "ytong", "porenbeton"),
         "timber": ("timber", "wood", "holz", "bois", "madera"),
         "brick": ("brick", "masonry", "ziegel", "mauerwerk", "brique", "ladrillo")}


def material_of(text):
    text = text.lower()
    return next((material for material, words in WORDS.items() if any(word in text for word in words)), "")


class IfcReader:
    """Walls, openings, columns, beams and slabs by their shapes."""

    def __init__(self, path, plan):
        try:
            import ifcopenshell  # type: ignore[import-not-found,unused-ignore]
            import ifcopenshell.geom  # type: ignore[import-not-found,unused-ignore]
            import ifcopenshell.util.element  # type: ignore[import-not-found,unused-ignore]
            import ifcopenshell.util.placement  # type: ignore[import-not-found,unused-ignore]
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
        corners = shape.geometry.faces
        space, filled = math.prod(b - a for a, b in zip(low, high)), volume(points, [corners[i:i + 3] for i in range(0, len(corners), 3)])
        if not entity.is_a("IfcOpeningElement") and filled < FULL * space:
            self.plan.notes.append(f"{self.what(entity)}: its shape, which fills {100 * filled / space:.0f} % of its box: the box is taken")

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
        levels = sorted(zip(self.elevations(), self.model.by_type("IfcBuildingStorey")), key=lambda level: level[0])
        if not levels:
            raise PlanError(f"{self.path}: has no IfcBuildingStorey")
        standing, walls = {}, []
        for entity in self.model.by_type("IfcWall") + self.model.by_type("IfcColumn") + self.model.by_type("IfcBeam"):
            self.plan.place = self.what(entity)
            storey = self.ifc.util.element.get_container(entity, ifc_class="IfcBuildingStorey")
            if storey is None:
                self.plan.notes.append(f"{self.what(entity)}: is in no storey")
                continue
            box = self.box(entity)
            standing[storey.id()] = max(standing.get(storey.id(), -math.inf), box[2](box[1])[2])
            walls.append((entity, storey.id(), box))
        floors = [(elevation, s.id()) for elevation, s in levels if s.id() in standing]
        if not floors:
            raise PlanError(f"{self.path}: no storey has a wall, a column or a beam")
        tops = [elevation for elevation, _ in floors[1:]] + [0.0]
        last = floors[-1]
        above = [elevation for elevation, _ in levels if elevation > last[0] + 1]
        tops[-1] = above[0] if above else standing[last[1]]
        self.plan.heights = [top - floor for (floor, _), top in zip(floors, tops)]
        self.levels = [(floor, top) for (floor, _), top in zip(floors, tops)]
        storeys = {ident: i for i, (_, ident) in enumerate(floors)}
        for entity, storey, box in walls:
            self.add(entity, storeys[storey], box)
        for slab in self.model.by_type("IfcSlab"):
            self.add_slab(slab)
        self.note_others()

    def elevations(self):
        """Of all storeys, where they are placed. Some programs place all of them at 0, and state elevations alone."""
        storeys = self.model.by_type("IfcBuildingStorey")
        stated = [(s.Elevation or 0.0) * self.scale for s in storeys]
        if not all(s.ObjectPlacement for s in storeys):
            return stated
        placed = [float(self.ifc.util.placement.get_local_placement(s.ObjectPlacement)[2][3]) * self.scale for s in storeys]
        return placed if len(set(placed)) >= len(set(stated)) else stated

    def note_others(self):
        """Kinds that plans have no part for; doors and windows are those of their openings."""
        counts = {}
        for entity in self.model.by_type("IfcElement"):
            if any(entity.is_a(kind) for kind in TAKEN) or (any(entity.is_a(kind) for kind in ("IfcDoor", "IfcWindow")) and entity.FillsVoids):
                continue
            counts[entity.is_a()] = counts.get(entity.is_a(), 0) + 1
        self.plan.notes += [f"{count} {kind}: plans have no such part" for kind, count in sorted(counts.items())]

    def storeys_of(self, entity, low, high):
        """That a part from a height to another stands in: those that it fills by more than half."""
        found = [i for i, (floor, top) in enumerate(self.levels) if min(high, top) - max(low, floor) > 0.5 * (top - floor)]
        if not found:
            self.plan.notes.append(f"{self.what(entity)}: is {high - low:.2f} m high: parts of plans stand from floor to floor")
        return found

    def add(self, entity, storey, box):
        low, high, to_world = box
        self.plan.place = self.what(entity)
        what, material, name = self.what(entity), self.material(entity), plain(entity.Name)
        middle, half = [(a + b) / 2 for a, b in zip(low, high)], [(b - a) / 2 for a, b in zip(low, high)]
        bottom, top = sorted((to_world(low)[2], to_world(high)[2]))
        if entity.is_a("IfcColumn"):
            a, b = to_world((low[0], low[1], 0)), to_world((high[0], high[1], 0))
            self.plan.is_along_x(to_world((low[0], middle[1], 0)), to_world((high[0], middle[1], 0)), what)
            words = [material] if material else []
            for i in self.storeys_of(entity, bottom, top):
                self.plan.add(i, line("column", (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, abs(a[0] - b[0]), abs(a[1] - b[1]), *words))
            return
        along = 0 if half[0] >= half[1] else 1
        ends = [list(middle), list(middle)]
        ends[0][along], ends[1][along] = low[along], high[along]
        a, b = to_world(ends[0]), to_world(ends[1])
        thickness = 2 * half[1 - along]
        if entity.is_a("IfcBeam"):
            self.plan.is_along_x(a, b, what)
            nearest = min(range(len(self.levels)), key=lambda i: abs(self.levels[i][1] - top))
            if abs(self.levels[nearest][1] - top) > BELOW_FLOOR:
                self.plan.notes.append(f"{what}: its height of {top - self.levels[storey][0]:.2f} m: beams of plans lie under a floor")
            words = [material] if material else []
            self.plan.add(nearest, line("beam", a[0], a[1], b[0], b[1], thickness, 2 * half[2], *words))
            return
        for i in self.storeys_of(entity, bottom, top):
            along_x = self.plan.wall(i, a[:2], b[:2], thickness, material, name, what)
            for opening in self.openings(entity):
                self.add_opening(opening, i, (a, b), along_x)

    def openings(self, entity):
        for relation in entity.HasOpenings:
            if relation.RelatedOpeningElement is None:
                raise PlanError(f"{self.path}: {self.what(entity)}: its #{relation.id()} {relation.is_a()} names no opening")
            yield relation.RelatedOpeningElement

    def add_opening(self, opening, storey, wall, along_x):
        low, high, to_world = self.box(opening)
        corners = [to_world((x, y, z)) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        i = 0 if along_x else 1
        ends, floor = sorted(point[i] for point in wall), self.levels[storey][0]
        first, last = max(min(c[i] for c in corners), ends[0]), min(max(c[i] for c in corners), ends[1])
        sill, head = min(c[2] for c in corners) - floor, max(c[2] for c in corners) - floor
        if head <= LEAST or sill >= self.plan.heights[storey] - LEAST:
            return  # of another storey of a high wall
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

    def add_slab(self, slab):
        low, high, to_world = self.box(slab)
        a, b = to_world(low), to_world(high)
        self.plan.is_along_x(to_world((low[0], low[1], 0)), to_world((high[0], low[1], 0)), self.what(slab))
        upper, tops = max(a[2], b[2]), [top for _, top in self.levels]
        # Its upper side is the next floor. What lies under the lowest storey is the ground.
        nearest = min(range(len(tops)), key=lambda i: abs(tops[i] - upper))
        if abs(upper - self.levels[0][0]) < abs(tops[nearest] - upper):
            self.plan.notes.append(f"{self.what(slab)}: lies on the ground")
            return
        if abs(tops[nearest] - upper) > BELOW_FLOOR:
            self.plan.notes.append(f"{self.what(slab)}: its height: it becomes the floor {upper - tops[nearest]:+.2f} m away")
        words = ["concrete" if self.material(slab) != "timber" else "timber"]
        self.plan.add(nearest, line("slab", min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1]), high[2] - low[2], *words))
        for opening in self.openings(slab):
            least, most, place = self.box(opening)
            c, d = place(least), place(most)
            self.plan.add(nearest, line("hole", min(c[0], d[0]), min(c[1], d[1]), max(c[0], d[0]), max(c[1], d[1])))
