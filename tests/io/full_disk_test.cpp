// A disk that fills up at any byte: the error is clear and no half-written file has a final name.
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <functional>

#include "io/datasets/tum_recorder.h"
#include "io/mesh/stl_writer.h"
#include "io/recording/recording_queue.h"
#include "io/scenes/pile_export.h"
#include "io/state/pile_state_file.h"
#include "kernel/base/error.h"
#include "tests/io/all_recorders.h"
#include "tests/io/small_scene.h"
#include "tests/io/support.h"

namespace rubble {
namespace full_disk_test {

using test::make_full_frame;
using test::ScratchFolder;

// Makes every write beyond `bytes` of a file fail, as a full disk does.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::size_t bytes) {
    old_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &old_limit_);
    const rlimit limit{bytes, old_limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_limit_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_limit_{};
  void (*old_handler_)(int);
};

void record(std::unique_ptr<Recorder> recorder) {
  for (int i = 0; i < 3; ++i) recorder->write(make_full_frame(i));
  recorder->finish();
}

PileState make_state() {
  PileState state;
  state.types = {"slab"};
  state.pieces.resize(20);
  return state;
}

TriangleMesh make_mesh() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles.assign(100, {0, 1, 2});
  return mesh;
}

PileModel make_model(const TriangleMesh& mesh) {
  PileModel model;
  model.types = {{"flag", &mesh}};
  for (std::uint32_t i = 0; i < 4; ++i)
    model.pieces.push_back({0, piece_name("flag", i), 1, {{}, {double(i), 0, 0}}});
  return model;
}

struct Writer {
  std::string name;
  std::function<void(const std::string& path)> write;
};

std::vector<Writer> all_writers() {
  std::vector<Writer> writers{{"pile.bin", [](const auto& p) { save_pile_state(make_state(), p); }},
                              {"pile.stl", [](const auto& p) {
                                 const TriangleMesh mesh = make_mesh();
                                 write_stl(p, {{&mesh, 1.0, {}}});
                               }}};
  using Export = void (*)(const std::string& path, const PileModel& model);
  for (const auto& [name, write] :
       std::initializer_list<std::pair<const char*, Export>>{{"pile.ply", write_ply},
                                                             {"pile.obj", write_obj},
                                                             {"pile.glb", write_glb}})
    writers.push_back({name, [write = write](const auto& p) {
                         const TriangleMesh mesh = make_mesh();
                         write(p, make_model(mesh));
                       }});
  for (const MeshFormat& format : mesh_formats()) {
    if (!format.is_folder) continue;
    writers.push_back({format.leaves.back(), [write = format.write](const auto& p) {
                         const TriangleMesh mesh = make_mesh();
                         write(p, test::make_scene(make_model(mesh)));
                       }});
  }
  for (const test::RecorderKind& kind : test::all_recorders(3))
    writers.push_back({kind.name, [kind](const auto& p) { record(kind.make(p)); }});
  return writers;
}

// The limit is on each file, so of a folder the largest one counts.
std::size_t largest_file(const std::string& path) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(path)) return fs::file_size(path);
  std::size_t largest = 0;
  for (const auto& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file()) largest = std::max<std::size_t>(largest, entry.file_size());
  return largest;
}

TEST(FullDisk, AtAnyByteItIsAnErrorAndNothingIsLeft) {
  for (const Writer& writer : all_writers()) {
    ScratchFolder folder;
    const std::string path = folder / writer.name;
    writer.write(path);
    const std::size_t size = largest_file(path);
    for (const std::string& name : folder.names()) std::filesystem::remove_all(folder / name);
    const std::size_t step = size / 23 + 1;
    std::vector<std::size_t> limits{size - 1, size - 2};
    for (std::size_t limit = 0; limit < size; limit += step) limits.push_back(limit);
    for (const std::size_t limit : limits) {
      const FileSizeLimit full(limit);
      try {
        writer.write(path);
        ADD_FAILURE() << writer.name << " of " << size << " bytes was written into " << limit;
      } catch (const RunError& error) {
        const std::string text = error.what();
        const bool beside = text.find(folder / "metadata.yaml") != std::string::npos;  // of an MCAP file
        EXPECT_TRUE(beside || text.find(path.substr(0, path.rfind('.'))) != std::string::npos) << text;
        EXPECT_NE(text.find("File too large"), std::string::npos) << text;
      }
      EXPECT_TRUE(folder.names().empty()) << writer.name << " left " << folder.names().front();
    }
    const FileSizeLimit enough(size);
    EXPECT_NO_THROW(writer.write(path)) << writer.name;
    EXPECT_EQ(largest_file(path), size);
  }
}

// A small file system of its own; needs the right to mount one.
class SmallDisk {
 public:
  SmallDisk() { mounted_ = mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, "size=256k") == 0; }
  ~SmallDisk() {
    if (mounted_) umount2(folder_.path().c_str(), MNT_DETACH);
  }
  bool mounted() const { return mounted_; }
  const ScratchFolder& folder() const { return folder_; }

 private:
  ScratchFolder folder_;
  bool mounted_ = false;
};

// The message of the failure; empty: everything fitted.
std::string record_until_full(const test::RecorderKind& kind, const ScratchFolder& folder,
                              int frames) {
  std::vector<std::unique_ptr<Recorder>> recorders;
  try {
    recorders.push_back(make_tum_trajectory_recorder(folder / "groundtruth.txt"));
    recorders.push_back(kind.make(folder / "recording"));
    RecordingQueue queue(std::move(recorders), 2);
    for (int i = 0; i < frames; ++i) queue.push(make_full_frame(i));
    queue.finish();
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

TEST(FullDisk, ARealOneStopsTheQueueAndLeavesNothing) {
  constexpr int kFrames = 40;
  int filled = 0;
  for (const test::RecorderKind& kind : test::all_recorders(kFrames)) {
    SmallDisk disk;
    if (!disk.mounted())
      GTEST_SKIP() << "no right to mount a tmpfs here; the size limit above covers the same paths";
    const std::string message = record_until_full(kind, disk.folder(), kFrames);
    if (message.empty()) continue;  // a trajectory or a contact sheet of so few frames is small
    ++filled;
    EXPECT_NE(message.find("No space left on device"), std::string::npos)
        << kind.name << ": " << message;
    // COCO's list and a WebDataset's last shard are written at the end, when the recorder before is finished.
    const bool late = kind.name == "coco" || kind.name == "webdataset";
    const std::vector<std::string> left = disk.folder().names(), whole{"groundtruth.txt"};
    EXPECT_TRUE(left.empty() || (late && left == whole)) << kind.name;
  }
  EXPECT_GE(filled, 9);
}

}  // namespace full_disk_test
}  // namespace rubble
