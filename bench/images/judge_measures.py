"""Images in linear light as portable float maps, and how far two of them are apart."""
import numpy


def read_pfm(path):
    """Height x width x 3, rows from the top."""
    with open(path, "rb") as file:
        kind, size, scale = file.readline(), file.readline(), file.readline()
        if kind != b"PF\n" or float(scale) >= 0:
            raise ValueError("%s is no little-endian colour image in the portable float map format" % path)
        width, height = map(int, size.split())
        values = numpy.frombuffer(file.read(), "<f4")
    if values.size != width * height * 3:
        raise ValueError("%s has %d numbers, not %d x %d x 3" % (path, values.size, width, height))
    return values.reshape(height, width, 3)[::-1].astype(float)


def write_pfm(path, image):
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (image.shape[1], image.shape[0]))
        file.write(image[::-1].astype("<f4").tobytes())


def region_means(image, regions):
    """Means over a grid of regions x regions rectangles, for each colour."""
    rows = numpy.array_split(image, regions, axis=0)
    parts = [numpy.array_split(row, regions, axis=1) for row in rows]
    return numpy.array([[part.mean(axis=(0, 1)) for part in row] for row in parts])


def compare(ours, judge, regions=16):
    """Differences of region means relative to the judge's, for each of red, green and blue: `mean` and
    `worst` of their sizes over regions and colours, and `signed`, their mean with sign, in which noise cancels out.
    Regions darker than 1 % of the mean count as that dark, as in compare_regions() of image_measures.h."""
    if ours.shape != judge.shape:
        raise ValueError("images of different sizes, %s and %s" % (ours.shape, judge.shape))
    a, b = region_means(ours, regions), region_means(judge, regions)
    floor = 0.01 * judge.mean(axis=(0, 1))
    differences = (a - b) / numpy.maximum(b, floor)
    errors = numpy.abs(differences)
    row, column, _ = numpy.unravel_index(errors.argmax(), errors.shape)
    return {"mean": errors.mean(), "signed": differences.mean(), "worst": errors.max(), "worst_row": int(row),
            "worst_column": int(column)}
