#!/usr/bin/env python3
"""Compares the topics that the settings of RViz and Foxglove name with those of the bag beside them.

usage: viewer_settings_reader.py FOLDER      # of a run that was packed; prints each difference
"""
import json
import sys

import rosbag
import yaml

SHOWN = ("sensor_msgs/Image", "sensor_msgs/CompressedImage", "sensor_msgs/PointCloud2", "sensor_msgs/LaserScan")


def topics_of_rviz(path, ros):
    """Pairs of topic and class without its package."""
    with open(path, encoding="utf-8") as file:
        manager = yaml.safe_load(file)["Visualization Manager"]
    assert manager["Global Options"]["Fixed Frame"] == "world", path
    found = set()
    for display in manager["Displays"]:
        package, kind = display["Class"].split("/")
        assert package == ("rviz" if ros == 1 else "rviz_default_plugins"), display
        topic = display.get("Depth Map Topic") or display.get("Image Topic") or display.get("Topic")
        if isinstance(topic, dict):
            topic = topic["Value"]
        hint = display.get("Depth Map Transport Hint") or display.get("Transport Hint", "raw")
        if topic:
            found.add((topic if hint == "raw" else topic + "/" + hint, kind))
    return found


def panels_of(layout):
    if isinstance(layout, str):
        return [layout]
    return panels_of(layout["first"]) + panels_of(layout["second"])


def main():
    folder = sys.argv[1]
    with rosbag.Bag(folder + "/mission.bag") as bag:
        recorded = {name: info.msg_type for name, info in bag.get_type_and_topic_info().topics.items()}
    wanted = {name for name, kind in recorded.items() if kind in SHOWN and "/ground_truth/" not in name}
    wrong = []
    for ros in (1, 2):
        shown = topics_of_rviz(f"{folder}/settings/ros{ros}.rviz", ros)
        names = {name for name, _ in shown}
        wrong += [f"ros{ros}.rviz: {name} is not in the bag" for name in sorted(names - set(recorded))]
        wrong += [f"ros{ros}.rviz leaves out {name}" for name in sorted(wanted - names)]
        for name, kind in sorted(shown):
            clouds = kind in ("PointCloud2", "LaserScan")
            if clouds and name in recorded and recorded[name] != "sensor_msgs/" + kind:
                wrong.append(f"ros{ros}.rviz: {name} is no {kind}")
    with open(folder + "/settings/foxglove.json", encoding="utf-8") as file:
        layout = json.load(file)
    assert sorted(panels_of(layout["layout"])) == sorted(layout["configById"])
    named = set()
    for panel in layout["configById"].values():
        named |= set(panel.get("topics", {}))
        if "imageMode" in panel:
            named.add(panel["imageMode"]["imageTopic"])
        named |= {path["value"].split(".")[0] for path in panel.get("paths", [])}
    wrong += [f"foxglove.json: {name} is not in the bag" for name in sorted(named - set(recorded))]
    wrong += [f"foxglove.json leaves out {name}" for name in sorted(wanted - named)]
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
