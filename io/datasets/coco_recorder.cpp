#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "io/base/folder_writer.h"
#include "io/datasets/dataset_recorders.h"
#include "io/image/image_file.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

using CocoJson = nlohmann::ordered_json;

// Pixels of one piece in a picture.
struct CocoRegion {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> runs;  // begin and length, column by column
  int left = 1 << 30, top = 1 << 30, right = -1, bottom = -1;
  std::uint64_t area = 0;

  void add(int column, int row, int height) {
    const auto at = std::uint32_t(column * height + row);
    if (!runs.empty() && runs.back().first + runs.back().second == at)
      ++runs.back().second;
    else
      runs.emplace_back(at, 1);
    left = std::min(left, column), right = std::max(right, column);
    top = std::min(top, row), bottom = std::max(bottom, row);
    ++area;
  }

  // Lengths of runs of zeros and ones in turn.
  std::vector<std::int64_t> counts(std::int64_t pixels) const {
    std::vector<std::int64_t> counts;
    std::int64_t end = 0;
    for (const auto& [begin, length] : runs) {
      counts.insert(counts.end(), {begin - end, std::int64_t(length)});
      end = std::int64_t(begin) + length;
    }
    if (end < pixels) counts.push_back(pixels - end);
    return counts;
  }
};

// COCO's text of run lengths: from the third on as differences to the one before the last, five bits a letter.
std::string pack_counts(const std::vector<std::int64_t>& counts) {
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::int64_t value = counts[i] - (i > 2 ? counts[i - 2] : 0);
    for (bool more = true; more;) {
      const std::int64_t bits = value & 31;
      value = (value - bits) / 32;
      more = bits & 16 ? value != -1 : value != 0;
      text += char(48 + bits + (more ? 32 : 0));
    }
  }
  return text;
}

// The class of each number of the stream `instance`.
class CocoClasses {
 public:
  explicit CocoClasses(const Legend& legend) : legend_(legend), victims_(legend.labels.size()) {
    for (const Legend::Piece& piece : legend.pieces)
      if (piece.victim) victims_.at(piece.label) = true;
    const auto robot = std::find(legend.labels.begin(), legend.labels.end(), "robot");
    robot_ = robot == legend.labels.end() ? -1 : int(robot - legend.labels.begin());
  }

  std::size_t of(std::uint32_t instance) const {
    if (instance < legend_.pieces.size()) return legend_.pieces[instance].label;
    for (const auto& [list, first] : {std::pair(&legend_.surroundings, legend_.first_surrounding),
                                      std::pair(&legend_.fines, legend_.first_fine)})
      if (!list->empty() && instance >= first && instance - first < list->size()) return (*list)[instance - first].label;
    if (robot_ >= 0) return std::size_t(robot_);
    throw RunError("the legend has no piece " + std::to_string(instance));
  }

  CocoJson categories() const {
    CocoJson list = CocoJson::array();
    for (std::size_t label = kFirstAssetLabel; label < legend_.labels.size(); ++label)
      list.push_back({{"id", label},
                      {"name", legend_.labels[label]},
                      {"supercategory", int(label) == robot_ ? "robot" : victims_[label] ? "victim" : "piece"}});
    return list;
  }

 private:
  const Legend& legend_;
  std::vector<bool> victims_;  // by label
  int robot_ = -1;             // label of robots; -1: there is none
};

class CocoRecorder : public Recorder {
 public:
  CocoRecorder(const std::string& path, const Recording& recording, int threads)
      : recording_(recording), classes_(recording_.legend), order_(path, channels_of_coco()), folder_(path, {"images"}, threads) {}

  void write(const Frame& frame) override {
    order_.check(frame);
    const Intrinsics& k = frame.intrinsics;
    const std::string name = index_text(frame.index) + ".png";
    folder_.add("images/" + name, [image = RgbImage{k.width, k.height, frame.rgb}] { return encode_png(image); });
    images_.push_back({{"id", frame.index + 1},
                       {"file_name", name},
                       {"width", k.width},
                       {"height", k.height},
                       {"stamp_ns", frame.stamp_ns}});
    for (const auto& [instance, region] : regions_of(frame)) add_annotation(frame, instance, region);
  }

  void finish() override {
    CocoJson json{{"info", {{"description", "simulated by Rubble"}, {"version", "1.0"}}},
                  {"licenses", CocoJson::array()},
                  {"categories", classes_.categories()},
                  {"images", images_}};
    std::string text = json.dump();
    text.pop_back();
    folder_.write("annotations.json", text + ",\"annotations\":[" + annotations_ + "]}\n");
    folder_.finish();
  }

 private:
  static Channels channels_of_coco() {
    Channels channels;
    channels.truth = {find_image_stream("instance")};
    return channels;
  }

  static std::map<std::uint32_t, CocoRegion> regions_of(const Frame& frame) {
    std::map<std::uint32_t, CocoRegion> regions;
    const auto& instance = frame.get<std::uint32_t>("instance");
    const int width = frame.intrinsics.width, height = frame.intrinsics.height;
    for (int u = 0; u < width; ++u)
      for (int v = 0; v < height; ++v) {
        const std::uint32_t number = instance[std::size_t(v) * std::size_t(width) + std::size_t(u)];
        if (number != kNoInstance && number != kGroundInstance) regions[number].add(u, v, height);
      }
    return regions;
  }

  void add_annotation(const Frame& frame, std::uint32_t instance, const CocoRegion& r) {
    const Intrinsics& k = frame.intrinsics;
    const CocoJson json{{"id", ++annotation_count_},
                        {"image_id", frame.index + 1},
                        {"category_id", classes_.of(instance)},
                        {"bbox", {r.left, r.top, r.right - r.left + 1, r.bottom - r.top + 1}},
                        {"area", r.area},
                        {"iscrowd", 0},
                        {"instance", instance},
                        {"segmentation",
                         {{"size", {k.height, k.width}},
                          {"counts", pack_counts(r.counts(std::int64_t(k.width) * k.height))}}}};
    annotations_ += (annotations_.empty() ? "\n" : ",\n") + json.dump();
  }

  Recording recording_;
  CocoClasses classes_;
  FrameOrder order_;
  FolderWriter folder_;
  std::uint64_t annotation_count_ = 0;
  CocoJson images_ = CocoJson::array();
  std::string annotations_;  // the list, so far
};

}  // namespace

std::unique_ptr<Recorder> make_coco_recorder(const std::string& path, const Recording& recording, int threads) {
  return std::make_unique<CocoRecorder>(path, recording, threads);
}

}  // namespace rubble
