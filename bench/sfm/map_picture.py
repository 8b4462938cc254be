"""What a map has of the surface that its run saw, and the map itself, both from above: the two clouds that
`rubble eval map --details` writes."""
import cv2
import numpy as np

PIXELS, TOP = 96, 1.2  # of a metre; what is higher is left out, or roofs would hide the floor; unit: m
MARGIN, HEADER = 8, 36  # unit: pixel
RED, BLUE = (40, 60, 210), (200, 110, 60)


def read_cloud(path):
    data = path.read_bytes()
    start = data.index(b"end_header\n") + len(b"end_header\n")
    cloud = np.frombuffer(data[start:], np.dtype([("p", "<f4", 3), ("rgb", "u1", 3), ("distance", "<f4")]))
    return cloud[cloud["p"][:, 2] < TOP]


class Plan:
    """World +Y to the right, -X up: the flight goes from left to right."""

    def __init__(self, points):
        self.low = np.array([points[:, 1].min(), points[:, 0].min()])
        extent = np.array([points[:, 1].max(), points[:, 0].max()]) - self.low
        width, height = np.ceil(extent * PIXELS).astype(int) + 2 * MARGIN
        self.image = np.full((height + HEADER, width, 3), 255, np.uint8)

    def pixels(self, points):
        flat = (points[:, [1, 0]] - self.low) * PIXELS + MARGIN
        flat[:, 1] += HEADER
        return np.round(flat).astype(int)

    def dots(self, points, colours, size):
        rows, columns = self.image.shape[:2]
        for (x, y), colour in zip(self.pixels(points), colours):
            if 0 <= x < columns and HEADER <= y < rows:
                cv2.rectangle(self.image, (x, y), (x + size - 1, y + size - 1), colour, -1)

    def title(self, text):
        cv2.putText(self.image, text, (12, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.6, (40, 40, 40), 1, cv2.LINE_AA)


def draw(details, name, title, out):
    seen = read_cloud(details / (name + "_seen.ply"))
    mapped = read_cloud(details / (name + "_map.ply"))
    above = Plan(seen["p"])
    order = np.argsort(seen["p"][:, 2])  # what is higher hides what is below
    shade = (0.55 + 0.45 * seen["p"][order, 2] / TOP)[:, None]
    above.dots(seen["p"][order], (seen["rgb"][order][:, ::-1] * shade).astype(int).tolist(), 2)
    above.title("visible surface below %.1f m, from above: green where the map has it within 5 cm" % TOP)
    foot = above.image.shape[0] - 30
    cv2.line(above.image, (30, foot), (30 + PIXELS, foot), (0, 0, 0), 2)
    cv2.putText(above.image, "1 m", (60, foot - 8), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 1, cv2.LINE_AA)
    below = Plan(seen["p"])
    colours = [RED if d >= 0.05 else BLUE for d in mapped["distance"]]
    below.dots(mapped["p"], colours, 4)
    below.title("the map: %s; red where 5 cm or more off" % title)
    line = np.full((5, above.image.shape[1], 3), 200, np.uint8)
    cv2.imwrite(str(out), np.vstack([above.image, line, below.image]))
