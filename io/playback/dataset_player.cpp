#include "io/playback/dataset_player.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>

#include "io/image/picture_importer.h"
#include "io/playback/recorded_picture.h"
#include "io/playback/recorded_tables.h"
#include "io/playback/ros_samples.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

bool has_file(const std::string& path) {
  std::error_code failed;
  return fs::exists(path, failed);
}

// key: of the outputs that would have recorded it.
[[noreturn]] void fail_missing(const std::string& path, const std::string& what, const std::string& key) {
  throw InputError({path, 0, "", "the dataset has no " + what + " that can be read back", path, "no such file or folder",
                    "record it with outputs." + key + " = true; `rubble remake` makes a dataset again"});
}

// A sample beside frames, read when it is its turn.
struct BesideSample {
  std::int64_t stamp_ns = 0;
  int rank = 0;  // of samples with one stamp: inertial units, then the other sensors in their order
  std::function<Sample()> read;
};

// The folder of one camera, with its tables.
struct FramesFolder {
  std::string path;           // that has `frames`
  std::vector<Frame> frames;  // without pictures
  std::vector<Event> events;
  std::size_t next = 0, next_event = 0;
};

}  // namespace

struct DatasetPlayer::State {
  explicit State(RecordedDataset played) : dataset(std::move(played)), pictures(dataset.folder) {}

  RecordedDataset dataset;
  PictureImporter pictures;
  std::vector<FramesFolder> folders;  // of each camera; empty: frames come from `ros`
  std::string ros;                    // the bag or MCAP file
  std::vector<BesideSample> beside;
  std::size_t next_beside = 0;
  std::vector<std::string> notes;
  bool rig_velocity_noted = false;
  std::map<std::string, std::map<std::int64_t, Pose>> poses_of_rigs;  // by what carries them

  bool several() const { return dataset.recording.cameras.size() > 1 || has_file(dataset.folder + "/cameras"); }
  std::string folder_of(std::size_t camera) const {
    return dataset.folder + (several() ? "/cameras/" + dataset.recording.cameras[camera].name : "");
  }

  void find_frames();
  std::string table_of_imu(std::size_t imu) const;  // empty: it has none
  bool is_beside_a_camera(std::size_t imu) const;
  int rank_of_sensor(std::size_t number) const { return int(dataset.recording.imus.size() + number); }
  void add_imus(const PlayedSamples& wanted);
  void add_scans();
  void add_readings();
  RosSampleSource ros_source() const;
  std::map<std::int64_t, Pose> carrier_poses(std::size_t camera) const;
  void set_rig_velocity(const CameraRecord& record, Frame& frame);
  const std::map<std::int64_t, Pose>& rig_poses(const std::string& carrier);
  Frame read_frame(std::size_t camera);
  void give(Frame frame, const std::function<void(Sample)>& take);
  void give_rest(const std::function<void(Sample)>& take);
  void play_folders(const std::function<void(Sample)>& take);
  void play_ros(const std::function<void(Sample)>& take);
};

void DatasetPlayer::State::find_frames() {
  const Recording& recording = dataset.recording;
  bool whole = true;
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) whole = whole && has_file(folder_of(i) + "/frames/poses.csv");
  if (whole) {
    for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
      const std::string path = folder_of(i);
      FramesFolder& folder = folders.emplace_back();
      folder.path = path;
      folder.frames = read_frame_poses(path + "/frames/poses.csv");
      if (recording.cameras[i].channels.events) folder.events = read_event_table(path + "/frames/events.txt");
    }
    notes.push_back("pictures and poses are those of the folder frames");
    return;
  }
  for (const char* name : {"mission.mcap", "mission.bag"}) {
    if (!has_file(dataset.folder + "/" + name)) continue;
    ros = dataset.folder + "/" + name;
    notes.push_back(std::string("pictures and poses are those of ") + name);
    return;
  }
  fail_missing(dataset.folder + "/mission.bag", "pictures", "bag = true, outputs.mcap = true or outputs.frames");
}

// The folder `frames` of a camera has the first unit that its carrier has, with biases.
std::string DatasetPlayer::State::table_of_imu(std::size_t imu) const {
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const std::string path = folders[i].path + "/frames/imu.csv";
    const int unit = find_imu_beside(dataset.recording, i);
    if ((several() ? unit : std::max(0, unit)) == int(imu) && has_file(path)) return path;
  }
  return "";
}

void DatasetPlayer::State::add_imus(const PlayedSamples& wanted) {
  const std::vector<ImuRecord>& imus = dataset.recording.imus;
  std::vector<ImuSample> samples;
  std::vector<bool> in_table;
  for (std::size_t i = 0; i < imus.size(); ++i) {
    const std::string path = table_of_imu(i);
    in_table.push_back(!path.empty());
    // Of further units no format holds the biases, unless a camera is beside them.
    if (path.empty() && wanted.biases && (i == 0 || is_beside_a_camera(i)))
      fail_missing(folder_of(0) + "/frames/imu.csv", "biases of " + imus[i].name, "frames");
    if (path.empty()) continue;
    for (const ImuSample& sample : read_imu_table(path, int(i))) samples.push_back(sample);
  }
  if (std::count(in_table.begin(), in_table.end(), false) > 0) {
    std::string path = ros;
    for (const char* name : {"/mission.mcap", "/mission.bag"})
      if (path.empty() && has_file(dataset.folder + name)) path = dataset.folder + name;
    if (path.empty()) fail_missing(dataset.folder + "/mission.bag", "inertial readings", "bag");
    for (const ImuSample& sample : read_ros_imus(path, dataset.recording))
      if (!in_table[std::size_t(sample.sensor)]) samples.push_back(sample);
  }
  for (const ImuSample& sample : samples) beside.push_back({sample.stamp_ns, sample.sensor, [sample] { return Sample(sample); }});
}

bool DatasetPlayer::State::is_beside_a_camera(std::size_t imu) const {
  for (std::size_t i = 0; i < dataset.recording.cameras.size(); ++i)
    if (find_imu_beside(dataset.recording, i) == int(imu)) return true;
  return false;
}

void DatasetPlayer::State::add_scans() {
  for (std::size_t i = 0; i < dataset.recording.sensors.size(); ++i) {
    const SensorRecord& sensor = dataset.recording.sensors[i];
    if (!sensor.scans()) continue;
    const std::string path = dataset.folder + "/pcd/" + sensor.name;
    if (!has_file(path)) fail_missing(path, "scans", "pcd");
    if (!sensor.format->scan_spec())
      throw InputError({path, 0, "", "the scans cannot be read back", "a sensor that states where its rays go", "one of another kind", ""});
    const auto scans = std::make_shared<const RecordedScans>(dataset.folder + "/pcd", sensor);
    for (std::size_t k = 0; k < scans->stamps_ns().size(); ++k)
      beside.push_back({scans->stamps_ns()[k], rank_of_sensor(i), [scans, k, i, stamp = scans->stamps_ns()[k]] {
                          return Sample(Reading{int(i), stamp, {}, scans->read(k)});
                        }});
  }
}

void DatasetPlayer::State::add_readings() {
  for (std::size_t i = 0; i < dataset.recording.sensors.size(); ++i) {
    const SensorRecord& sensor = dataset.recording.sensors[i];
    if (sensor.scans()) continue;
    const std::string path = dataset.folder + "/sensors/" + sensor.name + ".csv";
    if (!has_file(path)) fail_missing(path, "readings of " + sensor.name, "sensors");
    for (const Reading& reading : read_reading_table(path, sensor.format->columns().size(), int(i)))
      beside.push_back({reading.stamp_ns, rank_of_sensor(i), [reading] { return Sample(reading); }});
  }
}

// By groundtruth.txt, which has poses of the optical frame.
std::map<std::int64_t, Pose> DatasetPlayer::State::carrier_poses(std::size_t camera) const {
  const std::string path = folder_of(camera) + "/groundtruth.txt";
  if (!has_file(path)) fail_missing(path, "true poses of a camera on a robot", "groundtruth");
  std::map<std::int64_t, Pose> poses;
  const Pose carrier_from_optical = dataset.recording.cameras[camera].in_rig(camera_from_optical);
  for (const auto& [stamp_ns, world_from_optical] : read_tum_poses(path))
    poses[stamp_ns] = world_from_optical * carrier_from_optical.inverse();
  return poses;
}

RosSampleSource DatasetPlayer::State::ros_source() const {
  RosSampleSource source{ros, dataset.recording, dataset.intrinsics, {}};
  source.carriers.resize(dataset.recording.cameras.size());
  for (std::size_t i = 0; i < source.carriers.size(); ++i)
    if (!dataset.recording.cameras[i].carrier.empty()) source.carriers[i] = carrier_poses(i);
  return source;
}

// At the stamps of all cameras that it carries.
const std::map<std::int64_t, Pose>& DatasetPlayer::State::rig_poses(const std::string& carrier) {
  std::map<std::int64_t, Pose>& poses = poses_of_rigs[carrier];
  if (!poses.empty()) return poses;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const CameraRecord& record = dataset.recording.cameras[i];
    if (record.carrier != carrier) continue;
    for (const Frame& frame : folders[i].frames)
      poses[frame.stamp_ns] = record.is_rig() ? frame.world_from_camera : frame.world_from_camera * record.rig_from_camera.inverse();
  }
  return poses;
}

// The tables have the velocity of the camera. That of the rig is less by what its turning adds at the camera, which is
// found from the poses around.
void DatasetPlayer::State::set_rig_velocity(const CameraRecord& record, Frame& frame) {
  frame.rig_velocity = frame.linear_velocity;
  if (record.is_rig()) return;
  const std::map<std::int64_t, Pose>& poses = rig_poses(record.carrier);
  frame.rig_velocity = frame.linear_velocity - (velocity_at(poses, frame.stamp_ns, record.rig_from_camera.translation) -
                                                velocity_at(poses, frame.stamp_ns, {}));
  if (!rig_velocity_noted) notes.push_back("the angular velocity of the rig is the difference of its poses");
  rig_velocity_noted = true;
}

Frame DatasetPlayer::State::read_frame(std::size_t camera) {
  FramesFolder& folder = folders[camera];
  const CameraRecord& record = dataset.recording.cameras[camera];
  Frame frame = folder.frames[folder.next++];
  frame.sensor = int(camera);
  frame.intrinsics = dataset.intrinsics[camera];
  frame.baseline = record.baseline;
  frame.world_from_rig = record.is_rig() ? frame.world_from_camera : frame.world_from_camera * record.rig_from_camera.inverse();
  set_rig_velocity(record, frame);
  std::vector<std::string> channels{"rgb", "depth"};
  if (record.channels.right) channels.push_back("rgb_right");
  if (record.channels.measured_depth) channels.push_back("measured_depth");
  for (const ImageStream* stream : record.channels.truth) channels.push_back(stream->name);
  for (const std::string& channel : channels)
    put_picture(*read_frames_picture(pictures, folder.path, {channel, frame.index, record.channels.measured_depth}), channel, frame);
  while (folder.next_event < folder.events.size() && folder.events[folder.next_event].stamp_ns <= frame.stamp_ns)
    frame.events.push_back(folder.events[folder.next_event++]);
  return frame;
}

// What has its stamp comes before it.
void DatasetPlayer::State::give(Frame frame, const std::function<void(Sample)>& take) {
  for (; next_beside < beside.size() && beside[next_beside].stamp_ns <= frame.stamp_ns; ++next_beside)
    take(beside[next_beside].read());
  take(std::move(frame));
}

// What comes after the last frame.
void DatasetPlayer::State::give_rest(const std::function<void(Sample)>& take) {
  for (; next_beside < beside.size(); ++next_beside) take(beside[next_beside].read());
}

void DatasetPlayer::State::play_folders(const std::function<void(Sample)>& take) {
  for (;;) {
    std::optional<std::size_t> first;
    const auto stamp = [&](std::size_t i) { return folders[i].frames[folders[i].next].stamp_ns; };
    for (std::size_t i = 0; i < folders.size(); ++i)
      if (folders[i].next < folders[i].frames.size() && (!first || stamp(i) < stamp(*first))) first = i;
    if (!first) return;
    give(read_frame(*first), take);
  }
}

void DatasetPlayer::State::play_ros(const std::function<void(Sample)>& take) {
  const RosLosses losses = read_ros_frames(ros_source(), [&](Frame frame) { give(std::move(frame), take); });
  notes.push_back("velocities are the differences of recorded poses");
  if (losses.whole_millimetres) notes.push_back("depth is rounded to whole millimetres, as it is recorded");
  if (losses.jpeg) notes.push_back("colour was compressed as JPEG, with losses, when it was recorded");
}

DatasetPlayer::DatasetPlayer(RecordedDataset dataset, const PlayedSamples& wanted) : state_(std::make_unique<State>(std::move(dataset))) {
  state_->find_frames();
  if (wanted.imus) state_->add_imus(wanted);
  if (wanted.scans) state_->add_scans();
  if (wanted.readings) state_->add_readings();
  std::stable_sort(state_->beside.begin(), state_->beside.end(), [](const BesideSample& a, const BesideSample& b) {
    return std::tie(a.stamp_ns, a.rank) < std::tie(b.stamp_ns, b.rank);
  });
}

DatasetPlayer::~DatasetPlayer() = default;

const std::vector<std::string>& DatasetPlayer::notes() const { return state_->notes; }

void DatasetPlayer::play(const std::function<void(Sample)>& take) {
  std::map<int, std::pair<std::int64_t, std::int64_t>> last;  // of each camera: stamp and interval; unit: ns
  const auto mark_sequences = [&](Sample sample) {
    if (auto* frame = std::get_if<Frame>(&sample)) {
      auto& [stamp_ns, period_ns] = last[frame->sensor];
      const std::int64_t interval = frame->stamp_ns - stamp_ns;
      frame->starts_sequence = period_ns > 0 && (2 * interval > 3 * period_ns || 3 * interval < 2 * period_ns);
      period_ns = frame->index > 0 && !frame->starts_sequence ? (period_ns > 0 ? period_ns : interval) : 0;
      stamp_ns = frame->stamp_ns;
    }
    take(std::move(sample));
  };
  if (state_->ros.empty())
    state_->play_folders(mark_sequences);
  else
    state_->play_ros(mark_sequences);
  state_->give_rest(mark_sequences);
}

}  // namespace rubble
