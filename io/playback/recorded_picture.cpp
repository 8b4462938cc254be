#include "io/playback/recorded_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <sstream>

#include "io/image/flow_file.h"
#include "io/image/picture_importer.h"
#include "io/playback/picture_sources.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/read_file.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

using Importer = PictureImporter&;
using Wanted = const PictureWanted&;
using Found = std::optional<RecordedPicture>;

template <typename T>
std::vector<double> numbers(const std::vector<T>& values, double unit = 1) {
  std::vector<double> out;
  out.reserve(values.size());
  for (const T value : values) out.push_back(unit * static_cast<double>(value));
  return out;
}

Found read_colour(Importer importer, const std::string& folder, const std::string& name) {
  const RgbImage image = importer.read_rgb_png(folder + "/" + name);
  return RecordedPicture{name, image.width, image.height, 3, numbers(image.rgb)};
}

// unit: of the file's integers; 0: they are no depth.
Found read_integers(Importer importer, const std::string& folder, const std::string& name, double unit) {
  const DepthImage image = importer.read_depth_png(folder + "/" + name);
  return RecordedPicture{
      name, image.width, image.height, 1, numbers(image.values, unit > 0 ? unit : 1), unit};
}

Found read_exr_picture(Importer importer, const std::string& folder, const std::string& name,
                       const std::vector<std::string>& channels) {
  ExrImage image = importer.read_exr(folder + "/" + name, channels);
  return RecordedPicture{name, image.width, image.height, static_cast<int>(channels.size()),
                         std::move(image.values)};
}

// As frames_recorder.cpp writes them. stem: of the file's name, relative to the folder.
Found read_truth(Importer importer, const std::string& folder, const ImageStream& stream, const std::string& stem) {
  if (stream.file == ImageFile::png && stream.components == 3) return read_colour(importer, folder, stem + ".png");
  if (stream.file == ImageFile::png) return read_integers(importer, folder, stem + ".png", 0);
  if (stream.file == ImageFile::flo) {
    const FlowImage image = read_flow(folder + "/" + stem + ".flo");
    return RecordedPicture{stem + ".flo", image.width, image.height, 2, numbers(image.flow)};
  }
  const std::vector<std::string> names[] = {{"Y"}, {"R", "G"}, {"R", "G", "B"}};
  Found picture = read_exr_picture(importer, folder, stem + ".exr", names[stream.components - 1]);
  if (std::holds_alternative<PixelMaker<std::uint32_t>>(stream.make))
    for (double& value : picture->values) value = double(std::uint32_t(std::int32_t(value)));
  return picture;
}

}  // namespace

std::optional<RecordedPicture> read_frames_picture(PictureImporter& importer, const std::string& folder,
                                                   const PictureWanted& wanted) {
  const std::string& c = wanted.channel;
  const auto name = [&](const std::string& in, const char* suffix) {
    return "frames/" + in + "/" + index_text(wanted.frame) + suffix;
  };
  if (c == "rgb") return read_colour(importer, folder, name("rgb", ".png"));
  if (c == "rgb_right") return read_colour(importer, folder, name("right", ".png"));
  const ImageStream* stream = find_image_stream(c);
  if (stream && stream->is_truth()) return read_truth(importer, folder, *stream, "frames/" + c + "/" + index_text(wanted.frame));
  const bool truth_aside = c == "depth" && wanted.measured_depth;
  return read_exr_picture(importer, folder, name(truth_aside ? "depth_true" : "depth", ".exr"), {"Y"});
}

namespace {

// The file of a row of a TUM list, such as rgb.txt; empty: it has not so many.
std::string name_in_list(const std::string& list, int row) {
  std::istringstream in(read_file(list));
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && line[0] != '#' && row-- == 0) return line.substr(line.find(' ') + 1);
  return "";
}

Found from_tum(Importer importer, const std::string& folder, Wanted wanted) {
  const std::string& c = wanted.channel;
  if (c != "rgb" && c != "depth" && c != "measured_depth") return std::nullopt;
  const std::string list = c == "rgb" ? "rgb" : "depth";
  std::string name = name_in_list(folder + "/tum/" + list + ".txt", wanted.frame);
  if (name.empty()) return std::nullopt;
  if (c == "rgb") return read_colour(importer, folder, "tum/" + name);
  if (c == "depth" && wanted.measured_depth) name.insert(name.find('/'), "_true");
  return read_integers(importer, folder, "tum/" + name, 1.0 / 5000);
}

Found from_colmap(Importer importer, const std::string& folder, Wanted wanted) {
  if (wanted.channel != "rgb" && wanted.channel != "rgb_right") return std::nullopt;
  const std::string images = "colmap/images/" + (wanted.camera.empty() ? "" : wanted.camera + "/");
  std::error_code failed;
  const bool stereo = fs::is_directory(folder + "/" + images + "left", failed);
  if (!stereo && wanted.channel == "rgb_right") return std::nullopt;
  const std::string eye = images + (!stereo ? "" : wanted.channel == "rgb" ? "left/" : "right/");
  std::vector<std::string> names;  // of several cameras by instants
  for (const auto& entry : fs::directory_iterator(folder + "/" + eye, failed))
    if (entry.path().extension() == ".png") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  if (std::size_t(wanted.frame) >= names.size()) return std::nullopt;
  return read_colour(importer, folder, eye + names[std::size_t(wanted.frame)]);
}

Found from_bag(Importer, const std::string& folder, Wanted wanted) {
  return find_ros_picture(folder, "mission.bag", wanted);
}
Found from_mcap(Importer, const std::string& folder, Wanted wanted) {
  return find_ros_picture(folder, "mission.mcap", wanted);
}
Found from_rawlog(Importer, const std::string& folder, Wanted wanted) {
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
  using Reader = Found (*)(Importer, const std::string&, Wanted);
  PictureImporter importer(folder);
  std::vector<Reader> readers{read_frames_picture, from_bag, from_mcap, from_rawlog, from_tum, from_colmap};
  Found rounded;
  if (!wanted.camera.empty()) {
    rounded = find_in_folder_of_camera(folder, wanted, left_out);
    if (rounded && rounded->step == 0) return rounded;
    readers = {from_bag, from_mcap, from_rawlog, from_colmap};  // those that hold all cameras
  }
  for (const Reader read : readers) {
    try {
      Found found = read(importer, folder, wanted);
      if (!found || left_out.count(found->file)) continue;
      if (found->step == 0) return found;
      if (!rounded) rounded = std::move(found);
    } catch (const InputError&) {  // not there, or damaged: another may have it
    }
  }
  return rounded;
}

void put_picture(const RecordedPicture& picture, const std::string& channel, Frame& frame) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (channel == "rgb" || channel == "rgb_right") {
    std::vector<std::uint8_t>& rgb = channel == "rgb" ? frame.rgb : frame.rgb_right;
    rgb.assign(picture.values.begin(), picture.values.end());
    return;
  }
  if (channel == "depth" || channel == "measured_depth") {
    std::vector<float>& depth = channel == "depth" ? frame.depth : frame.measured_depth;
    for (const double value : picture.values) depth.push_back(float(picture.step > 0 && value == 0 ? kNone : value));
    return;
  }
  const ImageStream& stream = *find_image_stream(channel);
  ImageValues values = stream.blank(std::size_t(picture.width) * std::size_t(picture.height));
  std::visit(
      [&](auto& typed) {
        for (std::size_t i = 0; i < typed.size() && i < picture.values.size(); ++i) {
          const bool unknown = stream.file == ImageFile::flo && picture.values[i] >= double(kUnknownFlow);
          typed[i] = static_cast<typename std::decay_t<decltype(typed)>::value_type>(unknown ? kNone : picture.values[i]);
        }
      },
      values);
  frame.truth[channel] = std::move(values);
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
