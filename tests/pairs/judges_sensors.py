"""Sensors that give a few numbers: their tables against poses, by formulas of our own, and against the recording."""
import csv
import math

import numpy as np

import geometry
from dataset import need
from judges_motion import carrier_poses

LATITUDE, LONGITUDE = 42.36, -71.06  # where a mission without a place is; unit: degree
KINDS = ("range_finders", "bumpers", "attitudes", "barometers", "magnetometers", "gnss", "batteries")


def sensors(data, *kinds):
    for kind in kinds or KINDS:
        for name, settings in (data.scenario.get(kind) or {}).items():
            yield kind, name, settings


def read_table(data, name):
    """{stamp: values}"""
    with open(data.file("sensors", name + ".csv"), encoding="ascii") as file:
        return {int(row[0]): [float(value) for value in row[1:]] for row in list(csv.reader(file))[1:]}


def mounted(data, name, settings):
    """(stamp, values, place, rotation) of readings at whose stamps the carrier's pose is written down."""
    carrier = carrier_poses(data, settings)
    if carrier is None or settings["noise"]:
        return
    table = read_table(data, name)
    for stamp, place, turned in zip(*carrier):
        found = next((table[near] for near in range(int(stamp) - 2, int(stamp) + 3) if near in table), None)
        if found is not None:
            yield int(stamp), found, place + turned @ np.array(settings["position"]), turned @ geometry.rpy_matrix(settings["rpy_deg"])


def attitudes_meet_poses(data):
    for _, name, settings in sensors(data, "attitudes"):
        for stamp, (x, y, z, w), _, turned in mounted(data, name, settings):
            angle = geometry.angle_between(geometry.matrix(w, x, y, z), turned)
            need(angle < 1e-3, "%s at %d ns: %.4f rad beside the pose", name, stamp, angle)


def pressures_meet_heights(data):
    for _, name, settings in sensors(data, "barometers"):
        for stamp, (pressure,), place, _ in mounted(data, name, settings):
            height = settings["altitude"] + place[2]
            wanted = settings["sea_level_pressure"] * (1 - 2.25577e-5 * height) ** 5.25588
            need(abs(pressure - wanted) < 0.3, "%s at %d ns: %.2f Pa, at this height %.2f", name, stamp, pressure, wanted)


def fields_meet_poses(data):
    for _, name, settings in sensors(data, "magnetometers"):
        dip = math.radians(settings["inclination_deg"])
        north = math.radians(data.scenario["light"]["north_deg"] - settings["declination_deg"])
        field = settings["field_ut"] * 1e-6 * np.array([math.cos(dip) * math.cos(north), math.cos(dip) * math.sin(north), -math.sin(dip)])
        for stamp, found, _, turned in mounted(data, name, settings):
            wrong = float(np.linalg.norm(np.array(found) - turned.T @ field))
            need(wrong < 1e-3 * np.linalg.norm(field), "%s at %d ns: the field is %.3g T beside the Earth's", name, stamp, wrong)


def metres_a_degree(latitude, altitude):
    """To the north and to the east, on the ellipsoid of WGS 84."""
    axis, squared = 6378137.0, 6.69437999014e-3
    flat = 1 - squared * math.sin(math.radians(latitude)) ** 2
    north, east = axis * (1 - squared) / flat**1.5 + altitude, axis / math.sqrt(flat) + altitude
    return math.radians(north), math.radians(east * math.cos(math.radians(latitude)))


def fixes_meet_poses(data):
    """Those without noise, where there is a fix."""
    for _, name, settings in sensors(data, "gnss"):
        table = read_table(data, name)
        for stamp, values in table.items():
            need(values[3] >= 4 or math.isnan(values[0]), "%s at %d ns: a fix of %d satellites", name, stamp, values[3])
        light = data.scenario["light"]
        north = math.radians(light["north_deg"])
        by_place = data.row.get("light") == "by_place"
        latitude, longitude = (light["latitude_deg"], light["longitude_deg"]) if by_place else (LATITUDE, LONGITUDE)
        north_metres, east_metres = metres_a_degree(latitude, settings["altitude"])
        for stamp, values, place, _ in mounted(data, name, settings):
            if math.isnan(values[0]):
                continue
            up = (values[0] - latitude) * north_metres, (values[1] - longitude) * east_metres
            found = [up[1] * math.sin(north) + up[0] * math.cos(north), up[0] * math.sin(north) - up[1] * math.cos(north),
                     values[2] - settings["altitude"]]
            wrong = float(np.linalg.norm(np.array(found) - place))
            need(wrong < 0.02, "%s at %d ns: %.3f m beside the place", name, stamp, wrong)


def ranges_meet_geometry(data):
    """Ultrasound is no farther than the surface on the axis."""
    if data.solid is None or data.hidden_things or data.row.get("record_settling", "off") != "off":
        return
    for _, name, settings in sensors(data, "range_finders"):
        if settings["radiation"] != "ultrasound":
            continue
        for stamp, (found,), place, turned in mounted(data, name, settings):
            axis = data.solid.cast(place, turned @ np.array([1.0, 0, 0]))[0]
            if axis < settings["max_range"]:
                need(found <= axis + 2e-3, "%s at %d ns: %.3f m, on its axis a surface is at %.3f m", name, stamp, found, axis)


def readings_are_recorded(data):
    """As many messages as rows, each at its stamp."""
    if data.recording is None:
        return
    for kind, name, settings in sensors(data):
        topic = settings["topic"] or ("/battery_state" if kind == "batteries" else "/" + name)
        table = read_table(data, name)
        stamps = [stamp for stamp, _ in data.recording.topics.get(topic, [])]
        need(stamps == sorted(table), "%s of %s: %d messages, %d rows, or other stamps", topic, kind, len(stamps), len(table))
        steps = np.diff(sorted(table))
        need(not len(steps) or np.max(np.abs(steps - 1e9 / settings["rate_hz"])) <= 2 or data.row.get("record_settling", "off") != "off",
             "%s: its rows are not %s Hz", name, settings["rate_hz"])


def bumpers_say_what_they_feel(data):
    for _, name, settings in sensors(data, "bumpers"):
        for stamp, (pressed, force) in read_table(data, name).items():
            need(pressed == (force >= settings["threshold"]), "%s at %d ns: pressed %g by %g N", name, stamp, pressed, force)


def batteries_lose_what_they_give(data):
    """Without what the current is between readings: the charge falls by the current of each reading since the one before."""
    for _, name, settings in sensors(data, "batteries"):
        charge, last = settings["charge"], None
        for stamp, (voltage, current, left) in sorted(read_table(data, name).items()):
            if last is not None:
                charge = max(charge - current * (stamp - last) * 1e-9 / (3600 * settings["capacity_ah"]), 0)
            need(abs(left - charge) < 1e-9, "%s at %d ns: charge %.9f instead of %.9f", name, stamp, left, charge)
            need(current > 0 and voltage <= 4.2 * settings["cells"], "%s at %d ns: %g V, %g A", name, stamp, voltage, current)
            last = stamp


JUDGES = [attitudes_meet_poses, pressures_meet_heights, fields_meet_poses, fixes_meet_poses, ranges_meet_geometry,
          readings_are_recorded, bumpers_say_what_they_feel, batteries_lose_what_they_give]
