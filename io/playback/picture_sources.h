// Pictures out of rawlogs, ROS bags and MCAP files: for io/playback/recorded_picture.cpp.
#pragma once

#include "io/playback/recorded_picture.h"
#include "io/ros/ros_message_reader.h"

namespace rubble {

// Colour (lossless) and depth of `mission.rawlog`. Nothing: it has no such channel, or not so many
// frames. Throws InputError when there is none, or it is damaged before that frame.
std::optional<RecordedPicture> find_rawlog_picture(const std::string& folder,
                                                   const PictureWanted& wanted);

// Raw pictures (sensor_msgs/Image) alone. name: "mission.bag" or "mission.mcap". Nothing: it has no
// such topic, or not so many frames before the first fault. Throws InputError: no such file.
std::optional<RecordedPicture> find_ros_picture(const std::string& folder, const std::string& name,
                                                const PictureWanted& wanted);

// A sensor_msgs/Image of an encoding that Rubble writes. is_depth: whether 16UC1 is millimetres. Nothing: it is damaged or
// of another encoding.
std::optional<RecordedPicture> read_ros_image(const RosMessage& message, bool is_depth);

}  // namespace rubble
