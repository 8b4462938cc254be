"""Lines of a plan for rubble.read_plan, which the readers of rubble.import_plan write."""
import math

STRAIGHT = 0.01     # of a direction from an axis; unit: rad
LEAST = 0.01        # of a part's sides; unit: m
FARTHEST = 1e5      # of a part from the origin; unit: m
MOST_STOREYS = 12


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
