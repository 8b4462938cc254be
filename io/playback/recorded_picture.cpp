#include "io/playback/recorded_picture.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "io/base/number_text.h"
#include "io/image/exr_file.h"
#include "io/image/flow_file.h"
#include "io/image/image_file.h"
#include "io/playback/rawlog_pictures.h"
#include "io/playback/ros_pictures.h"
#include "kernel/base/error.h"
#include "kernel/base/read_file.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

using Wanted = const PictureWanted&;
using Found = std::optional<RecordedPicture>;

template <typename T>
std::vector<double> numbers(const std::vector<T>& values, double unit = 1) {
  std::vector<double> out;
  out.reserve(values.size());
  for (const T value : values) out.push_back(unit * static_cast<double>(value));
  return out;
}

Found read_colour(const std::string& folder, const std::string& name) {
  const RgbImage image = read_rgb_png(folder + "/" + name);
  return RecordedPicture{name, image.width, image.height, 3, numbers(image.rgb)};
}

// unit: of the file's integers; 0: they are no depth.
Found read_integers(const std::string& folder, const std::string& name, double unit) {
  const DepthImage image = read_depth_png(folder + "/" + name);
  return RecordedPicture{
      name, image.width, image.height, 1, numbers(image.values, unit > 0 ? unit : 1), unit};
}

Found read_exr_picture(const std::string& folder, const std::string& name,
                       const std::vector<std::string>& channels) {
  ExrImage image = read_exr(folder + "/" + name, channels);
  return RecordedPicture{name, image.width, image.height, static_cast<int>(channels.size()),
                         std::move(image.values)};
}

// As frames_recorder.cpp writes them. stem: of the file's name, relative to the folder.
Found read_truth(const std::string& folder, const ImageStream& stream, const std::string& stem) {
  if (stream.file == ImageFile::png && stream.components == 3) return read_colour(folder, stem + ".png");
  if (stream.file == ImageFile::png) return read_integers(folder, stem + ".png", 0);
  if (stream.file == ImageFile::flo) {
    const FlowImage image = read_flow(folder + "/" + stem + ".flo");
    return RecordedPicture{stem + ".flo", image.width, image.height, 2, numbers(image.flow)};
  }
  const std::vector<std::string> names[] = {{"Y"}, {"R", "G"}, {"R", "G", "B"}};
  Found picture = read_exr_picture(folder, stem + ".exr", names[stream.components - 1]);
  if (std::holds_alternative<PixelMaker<std::uint32_t>>(stream.make))
    for (double& value : picture->values) value = double(std::uint32_t(std::int32_t(value)));
  return picture;
}

// The plain folder, which has every channel bit for bit.
Found from_frames(const std::string& folder, Wanted wanted) {
  const std::string& c = wanted.channel;
  const auto name = [&](const std::string& in, const char* suffix) {
    return "frames/" + in + "/" + index_text(wanted.frame) + suffix;
  };
  if (c == "rgb") return read_colour(folder, name("rgb", ".png"));
  if (c == "rgb_right") return read_colour(folder, name("right", ".png"));
  const ImageStream* stream = find_image_stream(c);
  if (stream && stream->is_truth()) return read_truth(folder, *stream, "frames/" + c + "/" + index_text(wanted.frame));
  const bool truth_aside = c == "depth" && wanted.measured_depth;
  return read_exr_picture(folder, name(truth_aside ? "depth_true" : "depth", ".exr"), {"Y"});
}

// The file of a row of a TUM list, such as rgb.txt; empty: it has not so many.
std::string name_in_list(const std::string& list, int row) {
  std::istringstream in(read_file(list));
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && line[0] != '#' && row-- == 0) return line.substr(line.find(' ') + 1);
  return "";
}

Found from_tum(const std::string& folder, Wanted wanted) {
  const std::string& c = wanted.channel;
  if (c != "rgb" && c != "depth" && c != "measured_depth") return std::nullopt;
  const std::string list = c == "rgb" ? "rgb" : "depth";
  std::string name = name_in_list(folder + "/tum/" + list + ".txt", wanted.frame);
  if (name.empty()) return std::nullopt;
  if (c == "rgb") return read_colour(folder, "tum/" + name);
  if (c == "depth" && wanted.measured_depth) name.insert(name.find('/'), "_true");
  return read_integers(folder, "tum/" + name, 1.0 / 5000);
}

Found from_colmap(const std::string& folder, Wanted wanted) {
  const std::string name = index_text(wanted.frame) + ".png";
  if (wanted.channel == "rgb") return read_colour(folder, "colmap/images/" + name);
  if (wanted.channel == "rgb_right") return read_colour(folder, "colmap/images/right/" + name);
  return std::nullopt;
}

Found from_bag(const std::string& folder, Wanted wanted) {
  return find_ros_picture(folder, "mission.bag", wanted);
}
Found from_mcap(const std::string& folder, Wanted wanted) {
  return find_ros_picture(folder, "mission.mcap", wanted);
}
Found from_rawlog(const std::string& folder, Wanted wanted) {
  return find_rawlog_picture(folder, wanted);
}

// Formats that hold one camera leave the same files for each of several.
Found find_in_folder_of_camera(const std::string& folder, Wanted wanted,
                               const std::set<std::string>& left_out) {
  const std::string own = "cameras/" + wanted.camera + "/";
  PictureWanted alone = wanted;
  alone.camera.clear();
  std::set<std::string> left_out_here;
  for (const std::string& file : left_out)
    if (file.compare(0, own.size(), own) == 0) left_out_here.insert(file.substr(own.size()));
  Found found = find_recorded_picture(folder + "/" + own, alone, left_out_here);
  if (found) found->file.insert(0, own);
  return found;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

std::string pixel_text(const RecordedPicture& picture, std::size_t pixel) {
  std::string text;
  for (int c = 0; c < picture.components; ++c) {
    char number[40];
    std::snprintf(number, sizeof number, "%s%.9g", c ? " " : "",
                  picture.values[pixel * std::size_t(picture.components) + std::size_t(c)]);
    text += number;
  }
  return text;
}

}  // namespace

std::optional<RecordedPicture> find_recorded_picture(const std::string& folder,
                                                     const PictureWanted& wanted,
                                                     const std::set<std::string>& left_out) {
  using Reader = Found (*)(const std::string&, Wanted);
  std::vector<Reader> readers{from_frames, from_bag, from_mcap, from_rawlog, from_tum, from_colmap};
  Found rounded;
  if (!wanted.camera.empty()) {
    rounded = find_in_folder_of_camera(folder, wanted, left_out);
    if (rounded && rounded->step == 0) return rounded;
    readers = {from_bag, from_mcap, from_rawlog};  // those that hold all cameras
  }
  for (const Reader read : readers) {
    try {
      Found found = read(folder, wanted);
      if (!found || left_out.count(found->file)) continue;
      if (found->step == 0) return found;
      if (!rounded) rounded = std::move(found);
    } catch (const InputError&) {  // not there, or damaged: another may have it
    }
  }
  return rounded;
}

std::string describe_difference(const RecordedPicture& was, const RecordedPicture& is) {
  if (was.width != is.width || was.height != is.height || was.components != is.components)
    return "it has " + std::to_string(is.width) + "x" + std::to_string(is.height) +
           " pixels instead of " + std::to_string(was.width) + "x" + std::to_string(was.height);
  const auto step = static_cast<std::size_t>(was.components);
  std::size_t first = 0, count = 0;
  for (std::size_t pixel = 0; pixel * step < was.values.size(); ++pixel) {
    bool equal = true;
    for (std::size_t i = pixel * step; i < (pixel + 1) * step; ++i)
      equal = equal && same(was.values[i], is.values[i]);
    if (!equal && count++ == 0) first = pixel;
  }
  if (count == 0) return "";
  const auto width = static_cast<std::size_t>(was.width);
  return "pixel (" + std::to_string(first % width) + ", " + std::to_string(first / width) +
         ") is the first that differs: " + pixel_text(is, first) + " instead of " +
         pixel_text(was, first) + " (" + std::to_string(count) + " of " +
         std::to_string(was.values.size() / step) + " differ)";
}

}  // namespace rubble
