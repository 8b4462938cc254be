// Pictures out of an MRPT rawlog: for io/playback/recorded_picture.cpp.
#pragma once

#include "io/playback/recorded_picture.h"

namespace rubble {

// Colour (lossless) and depth of `mission.rawlog`. Nothing: it has no such channel, or not so many
// frames. Throws InputError when there is none, or it is damaged before that frame.
std::optional<RecordedPicture> find_rawlog_picture(const std::string& folder,
                                                   const PictureWanted& wanted);

}  // namespace rubble
