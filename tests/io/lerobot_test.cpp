// Datasets of LeRobot and the Parquet tables in them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/base/little_endian.h"
#include "io/learning/lerobot_dataset.h"
#include "io/learning/lerobot_recorder.h"
#include "io/learning/parquet_file.h"
#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble {
namespace lerobot_test {

using Json = nlohmann::json;
using test::read_text;
using test::ScratchFolder;

constexpr int kFrames = 3;

std::uint32_t big_endian_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

TEST(Lerobot, VideosHoldAJpegPictureForEachFrame) {
  ScratchFolder folder;
  const auto recorder = make_lerobot_recorder(folder / "le", test::full_recording(), 2);
  for (int i = 0; i < kFrames; ++i) test::write_full(*recorder, i);
  recorder->finish();
  const std::string mp4 = read_text(folder / "le/videos/observation.images.camera/chunk-000/file-000.mp4");
  std::vector<std::string> boxes;
  for (std::size_t at = 0; at < mp4.size(); at += big_endian_at(mp4, at)) boxes.push_back(mp4.substr(at + 4, 4));
  EXPECT_EQ(boxes, (std::vector<std::string>{"ftyp", "mdat", "mdat", "mdat", "moov"}));
  const std::size_t table = mp4.find("co64") + 8;
  ASSERT_EQ(big_endian_at(mp4, table), std::uint32_t(kFrames));
  for (std::size_t i = 0; i < kFrames; ++i) EXPECT_EQ(mp4.substr(big_endian_at(mp4, table + 8 + 8 * i), 2), "\xff\xd8");
  const Json info = Json::parse(read_text(folder / "le/meta/info.json"));
  EXPECT_EQ(info["total_frames"], kFrames);
  EXPECT_EQ(info["fps"], 30);
  EXPECT_EQ(info["features"]["observation.state"]["shape"][0], 10);
}

TEST(Lerobot, RefusesCamerasOfTwoRatesAndSecondSequences) {
  ScratchFolder folder;
  Recording two;
  two.cameras.resize(2);
  two.cameras[1].name = "side";
  const auto rates = make_lerobot_recorder(folder / "rates", two, 1);
  for (int i = 0; i < 2; ++i) rates->write(test::make_frame(i));
  Frame side = test::make_frame(1);
  side.sensor = 1, side.index = 0;
  rates->write(side);
  EXPECT_THROW(rates->finish(), RunError);
  const auto sequences = make_lerobot_recorder(folder / "sequences", {}, 1);
  sequences->write(test::make_frame(0));
  Frame later = test::make_frame(1);
  later.starts_sequence = true;
  EXPECT_THROW(sequences->write(later), RunError);
}

TEST(Lerobot, EpisodesFollowOneAnother) {
  ScratchFolder folder;
  LerobotDataset::Spec spec;
  spec.videos = {"observation.images.eye"};
  spec.features = {{"observation.state", LerobotFeature::Kind::values, {"a", "b"}},
                   {"next.reward", LerobotFeature::Kind::number},
                   {"next.done", LerobotFeature::Kind::flag}};
  spec.rate_hz = 5, spec.infos = true;
  LerobotDataset dataset(folder / "le", spec, 1);
  const auto play = [&](int rows, float first, const std::string& info) {
    for (int i = 0; i < rows; ++i) {
      dataset.add_picture(0, i * 200000000LL, 16, 8, std::vector<std::uint8_t>(16 * 8 * 3, 90));
      dataset.add_row(i * 200000000LL, {{first + float(i), 0}, {0.5f}, {i + 1 == rows ? 1.0f : 0.0f}});
    }
    dataset.end_episode(info);
  };
  play(3, 0, "first");
  play(2, 10, "second");
  EXPECT_THROW(dataset.add_row(0, {{1}, {0}, {0}}), RunError) << "a list of another length";
  EXPECT_THROW(dataset.add_picture(0, 0, 8, 8, std::vector<std::uint8_t>(8 * 8 * 3)), RunError) << "another size";
  dataset.finish();
  const Json info = Json::parse(read_text(folder / "le/meta/info.json"));
  EXPECT_EQ(info["total_episodes"], 2);
  EXPECT_EQ(info["total_frames"], 5);
  EXPECT_EQ(info["fps"], 5);
  EXPECT_EQ(info["splits"]["train"], "0:2");
  EXPECT_EQ(info["features"]["next.done"]["dtype"], "bool");
  EXPECT_EQ(Json::parse(read_text(folder / "le/meta/stats.json"))["observation.state"]["max"][0], 11);
  EXPECT_NE(read_text(folder / "le/meta/episodes/chunk-000/file-000.parquet").find("second"), std::string::npos);
  // 18000 ticks of 1/90000 s for each of five pictures: the second episode begins where the first one ends.
  const std::string mp4 = read_text(folder / "le/videos/observation.images.eye/chunk-000/file-000.mp4");
  const std::size_t times = mp4.find("stts") + 8;
  EXPECT_EQ(big_endian_at(mp4, times), 1u);
  EXPECT_EQ(big_endian_at(mp4, times + 4), 5u);
  EXPECT_EQ(big_endian_at(mp4, times + 8), 18000u);
}

TEST(Lerobot, RefusesADatasetWithoutEpisodes) {
  ScratchFolder folder;
  LerobotDataset none(folder / "none", {}, 1);
  EXPECT_THROW(none.finish(), RunError);
}

TEST(Parquet, HasEightFlagsInAByte) {
  ParquetTable table;
  table.add("flag", std::vector<bool>{true, false, false, true, false, false, false, false, true});
  EXPECT_NE(table.encode().find(std::string("\x09\x01", 2)), std::string::npos);
}

TEST(Parquet, HasItsFooterAndValues) {
  ParquetTable table;
  table.add("index", std::vector<std::int64_t>{7, 8});
  table.add_lists("state", std::vector<std::vector<float>>{{1, 2}, {3, 4}});
  const std::string bytes = table.encode();
  EXPECT_EQ(bytes.substr(0, 4), "PAR1");
  EXPECT_EQ(bytes.substr(bytes.size() - 4), "PAR1");
  std::uint32_t footer = 0;
  std::string_view tail = std::string_view(bytes).substr(bytes.size() - 8);
  take(tail, footer);
  ASSERT_LT(footer, bytes.size() - 12);
  EXPECT_NE(bytes.substr(bytes.size() - 8 - footer).find("state"), std::string::npos);
  std::string values;
  for (const float v : {1.f, 2.f, 3.f, 4.f}) put(values, v);
  EXPECT_NE(bytes.find(values), std::string::npos);
  table.add("short", std::vector<std::int64_t>{7});
  EXPECT_THROW(table.encode(), RunError);
}

}  // namespace lerobot_test
}  // namespace rubble
