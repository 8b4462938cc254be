// Pictures, elevation models, accelerograms and calibrations that a script reads.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "scripting/files/accelerogram.h"
#include "scripting/files/calibration.h"
#include "scripting/files/data_grid.h"
#include "tests/io/tiff_bytes.h"
#include "tests/scripting/script_files.h"

namespace rubble {
namespace data_files_test {

using testing::TiffBytes;

class DataFiles : public ScriptFiles {
 protected:
  Mission terrain(const std::string& arguments) { return load("pile = { terrain = rubble.terrain.image(" + arguments + ") }"); }
  std::string terrain_error(const std::string& arguments) {
    return error_of([&] { terrain(arguments); });
  }
  static bool printed(const Mission& mission, const std::string& words) {
    for (const std::string& line : mission.printed)
      if (line.find(words) != std::string::npos) return true;
    return false;
  }
};

// 5 x 2 pixels of 16 bits, each row 0, 1/4, 1/2, 3/4 and 1 of white. Written by another program.
const unsigned char kRamp16[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
    0x00, 0x00, 0x05, 0x00, 0x00, 0x00, 0x02, 0x10, 0x00, 0x00, 0x00, 0x00, 0xe5, 0x91, 0x95, 0xc2, 0x00,
    0x00, 0x00, 0x16, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x60, 0x60, 0x70, 0x60, 0x68, 0x60, 0xd8,
    0xff, 0xff, 0xff, 0x7f, 0x06, 0x04, 0x13, 0x00, 0x4d, 0x56, 0x08, 0xf9, 0xdf, 0x16, 0x28, 0x90, 0x00,
    0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

// Two pixels of 8 bits: green, and (10, 20, 30). Written by another program.
const unsigned char kColours[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
    0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00, 0x00, 0x7b, 0x40, 0xe8, 0xdd, 0x00,
    0x00, 0x00, 0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0xf8, 0xcf, 0xc0, 0x25, 0x22, 0x07,
    0x00, 0x05, 0x66, 0x01, 0x3c, 0x18, 0x56, 0x15, 0xac, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44,
    0xae, 0x42, 0x60, 0x82};

// The text that a run keeps has whole levels; brightness lies between them.
TEST(DataGridText, OfColoursIsReadAgain) {
  const DataGrid grid = read_data_grid({reinterpret_cast<const char*>(kColours), sizeof kColours});
  EXPECT_EQ(grid.white, 255);
  EXPECT_EQ(grid.values, (std::vector<double>{182, 19}));
  const DataGrid again = read_data_grid(data_grid_text(grid));
  EXPECT_EQ(again.values, grid.values);
  EXPECT_EQ(again.white, grid.white);
  EXPECT_TRUE(again.colour);
}

TEST_F(DataFiles, SixteenBitHeightsAreARamp) {
  write("ramp.png", std::string(reinterpret_cast<const char*>(kRamp16), sizeof kRamp16));
  const Mission mission = terrain("'ramp.png', { length = 4, amplitude = 4 }");
  const auto& t = mission.scenario.pile.terrain;
  ASSERT_EQ(t.heights.size(), 10u);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(t.heights[std::size_t(i)], i, 1e-4) << i;
  // The kept text is read again as the picture was.
  MissionOptions options;
  options.included.emplace();
  (*options.included)["ramp.png"] = mission.included[0].text;
  EXPECT_EQ(load_mission_text(mission.script.text, mission.script.path, options).scenario.pile.terrain.heights, t.heights);
}

TEST_F(DataFiles, GeoTiffHeightsKeepTheirScale) {
  write("dem.tif", TiffBytes(3, 2, 3, std::vector<float>{812, 813, 815, 810, 811, 812}).ground(30, 30, 500000, 4100060).geo_keys(1).bytes());
  const Mission mission = terrain("'dem.tif'");
  const auto& t = mission.scenario.pile.terrain;
  EXPECT_EQ(t.spacing, 30);
  EXPECT_EQ(t.heights, (std::vector<double>{0, 1, 2, 2, 3, 5})) << "the lowest y first, the lowest height at 0";
  EXPECT_TRUE(printed(mission, "heights from 810 to 815 m"));
  EXPECT_TRUE(printed(mission, "the centre at east 500045, north 4100030"));
  EXPECT_EQ(terrain("'dem.tif', { amplitude = 10, length = 4 }").scenario.pile.terrain.heights.back(), 10);
  EXPECT_EQ(terrain("'dem.tif', { amplitude = 10, length = 4 }").scenario.pile.terrain.spacing, 2);
}

TEST_F(DataFiles, WhatAnElevationModelLacksIsSaid) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  write("gap.tif", TiffBytes(2, 2, 3, std::vector<float>{1, none, 3, 4}).bytes());
  EXPECT_NE(terrain_error("'gap.tif'").find("1 of 4 points of gap.tif have no height: give `missing`"), std::string::npos);
  EXPECT_EQ(terrain("'gap.tif', { missing = 1 }").scenario.pile.terrain.heights, (std::vector<double>{2, 3, 0, 0}));
  write("degrees.tif", TiffBytes(2, 2, 2, std::vector<std::int16_t>{1, 2, 3, 4}).ground(0.0003, 0.0003, 8, 47).geo_keys(2).bytes());
  EXPECT_NE(terrain_error("'degrees.tif'").find("degrees: give `length`"), std::string::npos);
  EXPECT_EQ(terrain("'degrees.tif', { length = 30 }").scenario.pile.terrain.spacing, 30);
  write("map.gif", "GIF89a");
  EXPECT_NE(terrain_error("'map.gif'").find("is a GIF picture; PNG, JPEG, TIFF, OpenEXR, WebP, BMP, PGM, PPM, PBM and PFM are read: convert it"), std::string::npos);
  write("m.tif", TiffBytes(2, 2, 3, std::vector<float>{1, 2, 3, 4}).bytes());
  EXPECT_NE(error_of([&] { load("pile = rubble.include('m.tif')"); }).find("but a picture: rubble.read_image reads it"), std::string::npos);
}

TEST_F(DataFiles, ThinningIsPrintedAndCanBeAvoided) {
  std::vector<std::uint16_t> ramp(600 * 4);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = std::uint16_t(100 * (i % 600));
  write("wide.tif", TiffBytes(600, 4, 1, ramp).bytes());
  const Mission thin = terrain("'wide.tif'");
  EXPECT_EQ(thin.scenario.pile.terrain.columns, 200);
  EXPECT_TRUE(printed(thin, "averaged over blocks of 3 by 3"));
  const Mission whole = terrain("'wide.tif', { samples = 600 }");
  EXPECT_EQ(whole.scenario.pile.terrain.columns, 600);
  EXPECT_FALSE(printed(whole, "averaged"));
  EXPECT_NEAR(whole.scenario.pile.terrain.heights[599], 2 * 59900.0 / 65535, 1e-9);
  MissionOptions options;
  options.included.emplace();
  (*options.included)["wide.tif#600"] = whole.included[0].text;
  EXPECT_EQ(load_mission_text(whole.script.text, whole.script.path, options).scenario.pile.terrain.heights,
            whole.scenario.pile.terrain.heights);
}

TEST(DataGrid, AnEsriGridIsReadWithItsGapsAndWrittenBack) {
  const std::string text = "ncols 3\r\nnrows 2\nxllcorner 500000\nyllcorner 4.1e6\ncellsize 30\nNODATA_value -9999\n1 2 3\n4 -9999 6.5\n";
  ASSERT_TRUE(is_data_grid(text));
  const DataGrid grid = read_data_grid(text);
  EXPECT_TRUE(grid.metric());
  EXPECT_EQ(grid.spacing, 30);
  EXPECT_EQ(grid.north, 4.1e6);
  EXPECT_TRUE(std::isnan(grid.values[4]));
  EXPECT_EQ(grid.values[5], 6.5);
  const DataGrid thin = thinned(grid, 2);
  EXPECT_EQ(thin.columns, 2);
  EXPECT_EQ(thin.spacing, 60);
  EXPECT_TRUE(std::isnan(thin.values[0])) << "a point of the block has none";
  EXPECT_EQ(thin.values[1], (3 + 6.5) / 2);
  const DataGrid again = read_data_grid(data_grid_text(thin));
  EXPECT_TRUE(std::isnan(again.values[0]));
  EXPECT_EQ(again.values[1], thin.values[1]);
  EXPECT_EQ(again.block, 2);
  EXPECT_THROW(read_data_grid("ncols 3\nnrows 2\ncellsize 1\n1 2\n"), std::runtime_error);
}

TEST(DataGrid, TheHeadOfAnEsriGridHasAnyOrderAndCase) {
  for (const char* head : {"nrows 2\nncols 3\ncellsize 5\n", "CELLSIZE 5\r\nNROWS 2\r\nNCOLS 3\r\n",
                           "NODATA_value -9999\nxllcorner 0\nyllcorner 0\nNcols 3\nNrows 2\ncellsize 5\n"}) {
    const std::string text = std::string(head) + "1 2 3\n4 5 6\n";
    ASSERT_TRUE(is_data_grid(text)) << head;
    const DataGrid grid = read_data_grid(text);
    EXPECT_EQ(grid.columns, 3);
    EXPECT_EQ(grid.spacing, 5);
    EXPECT_EQ(grid.values[5], 6);
  }
  EXPECT_FALSE(is_data_grid("cellsize = 5\n")) << "Lua";
  EXPECT_FALSE(is_data_grid("dxf 5\n"));
}

// Of a plane, every value is the plane's at the middle of its block, wherever the blocks lie.
TEST(DataGrid, BlocksStayWhereTheyAreOnTheMap) {
  const auto plane = [](int columns, int rows) {
    std::string text = "ncols " + std::to_string(columns) + "\nnrows " + std::to_string(rows) + "\nxllcorner 500\nyllcorner 700\ncellsize 10\n";
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c)
        text += std::to_string(500 + 10 * c + 5 + 2 * (700 + 10 * (rows - 1 - r) + 5)) + (c + 1 < columns ? " " : "\n");
    return read_data_grid(text);
  };
  for (const auto& [columns, rows, cut_columns, cut_rows] : {std::array{12, 8, 0, 0}, std::array{13, 9, 1, 1},
                                                             std::array{14, 11, 2, 3}, std::array{15, 10, 3, 2}}) {
    SCOPED_TRACE(columns);
    const DataGrid thin = thinned(plane(columns, rows), 4 - (columns == 12));
    ASSERT_EQ(thin.spacing, 40);
    EXPECT_EQ(thin.columns, 3);
    EXPECT_EQ(thin.rows, 2);
    EXPECT_EQ(thin.cut_columns, cut_columns);
    EXPECT_EQ(thin.cut_rows, cut_rows);
    for (int r = 0; r < thin.rows; ++r)
      for (int c = 0; c < thin.columns; ++c)
        EXPECT_EQ(thin.values[std::size_t(r * thin.columns + c)],
                  thin.east + 40 * c + 20 + 2 * (thin.north + 40 * (thin.rows - 1 - r) + 20));
    const DataGrid again = read_data_grid(data_grid_text(thin));
    EXPECT_EQ(again.cut_columns, cut_columns);
    EXPECT_EQ(again.cut_rows, cut_rows);
    EXPECT_EQ(again.north, thin.north);
  }
  const DataGrid narrow = thinned(plane(12, 5), 3);
  EXPECT_EQ(narrow.rows, 2) << "incomplete blocks, where whole ones were less than two";
  EXPECT_EQ(narrow.north, 700 - 20) << "they hang over on both sides";
}

TEST(DataGrid, AnEsriGridNeedsAHeadThatMakesSense) {
  const auto error = [](const std::string& head, bool kept = false) -> std::string {
    try {
      read_data_grid("ncols 3\nnrows 2\n" + head + "1 2 3\n4 5 6\n", kept);
    } catch (const std::runtime_error& failure) {
      return failure.what();
    }
    return "";
  };
  EXPECT_EQ(error("cellsize 2\nNODATA_value nan\n"), "");
  EXPECT_NE(error("cellsize 0\n").find("has the cellsize 0: expected the distance of its points, above 0"), std::string::npos);
  EXPECT_NE(error("cellsize -1\n").find("has the cellsize -1"), std::string::npos);
  EXPECT_NE(error("cellsize inf\n").find("no number after cellsize, in line 3"), std::string::npos);
  EXPECT_NE(error("cellsize 1\nxllcorner nan\n").find("no number after xllcorner, in line 4"), std::string::npos);
  EXPECT_EQ(error("cellsize 0\n", true), "") << "of a kept text, whose file had no spacing";
  EXPECT_THROW(read_data_grid("ncols 2.5\nnrows 2\ncellsize 1\n1 2 3 4 5\n"), std::runtime_error);
}

TEST_F(DataFiles, HeightsWithoutASpacingAreReadAgain) {
  write("bare.tif", TiffBytes(2, 2, 3, std::vector<float>{1, 2, 3, 4}).bytes());
  const Mission mission = terrain("'bare.tif'");
  MissionOptions options;
  options.included.emplace();
  (*options.included)["bare.tif"] = mission.included[0].text;
  EXPECT_EQ(load_mission_text(mission.script.text, mission.script.path, options).scenario.pile.terrain.heights,
            mission.scenario.pile.terrain.heights);
  write("zero.asc", "ncols 2\nnrows 2\ncellsize 0\n1 2\n3 4\n");
  EXPECT_NE(terrain_error("'zero.asc'").find("has the cellsize 0: expected"), std::string::npos);
}

TEST_F(DataFiles, WhatAveragingLeavesOutIsPrintedAndGapsNeedAHeight) {
  std::string text = "ncols 9\nnrows 8\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -1\n";
  for (int i = 0; i < 72; ++i) text += std::string(i == 20 ? "-1" : "4") + (i % 9 == 8 ? "\n" : " ");
  write("d.asc", text);
  EXPECT_NE(terrain_error("'d.asc', { samples = 4 }").find("1 of 6 averaged points of d.asc have no height"), std::string::npos);
  const Mission mission = terrain("'d.asc', { samples = 4, missing = 2 }");
  EXPECT_EQ(mission.scenario.pile.terrain.heights, (std::vector<double>{2, 2, 2, 0, 2, 2}));
  EXPECT_TRUE(printed(mission, "to 3 by 2, without 0 columns and 2 rows at the edges"));
  EXPECT_TRUE(printed(mission, "the centre at east 45, north 40"));
}

TEST(DataGrid, GreyLevelsStayIntegers) {
  const DataGrid grid = read_data_grid("P2 3 1 255\n0 255 10\n");
  EXPECT_EQ(data_grid_text(grid), "P2\n3 1\n255\n0 255 10\n");
  EXPECT_EQ(thinned(grid, 2).values, (std::vector<double>{128, 10}));
}

const char* const kPeer5 =
    "PEER NGA STRONG MOTION DATABASE RECORD\n IMPERIAL VALLEY 10/15/79 2316, EL CENTRO ARRAY 6, 230\n"
    " ACCELERATION TIME HISTORY IN UNITS OF G\n 7    .0050    NPTS, DT\n"
    "  -.1468930E-02  .2E-02 -3.0E-02 .1E-02 .5E-3\n 0.1 -.2\n";
const char* const kPeer8 =
    "PEER STRONG MOTION DATABASE\r\nLoma Prieta, 10/18/1989, Gilroy, 090\r\nACCELERATION TIME SERIES IN UNITS OF G\r\n"
    "NPTS=   10, DT=   .02000 SEC\r\n .1 .2 .3 .4 .5 .6 .7 -.8\r\n .01 .02\r\n";
const char* const kEsm =
    "EVENT_NAME: CENTRAL_ITALY\nORIGINAL_DATA_MEDIATOR: \nSAMPLING_INTERVAL_S: 0.005000\nNDATA: 4\nUNITS: cm/s^2\n"
    "DATA_TYPE: ACCELERATION\nUSER5:\n-100.0\n50\n0.5\n1e1\n";
const char* const kKnet =
    "Origin Time       2011/03/11 14:46:00\nLat.              38.103\nLong.             142.860\nDepth. (km)       24\n"
    "Mag.              9.0\nStation Code      MYG004\nStation Lat.      38.7292\nStation Long.     141.0217\n"
    "Station Height(m) 39\nRecord Time       2011/03/11 14:46:51\nSampling Freq(Hz) 100Hz\nDuration Time(s)  300\n"
    "Dir.              N-S\nScale Factor      2000(gal)/8000000\nMax. Acc. (gal)   2699.850\n"
    "Last Correction   2011/03/11 14:46:36\nMemo.\n   1000  2000  3000\n   4000\n";

TEST(Accelerograms, OfEachArchiveAreInMetresPerSecondSquared) {
  const Accelerogram five = parse_accelerogram(kPeer5, "a.at2"), eight = parse_accelerogram(kPeer8, "b.at2");
  EXPECT_EQ(five.values.size(), 7u);
  EXPECT_EQ(five.step, 0.005);
  EXPECT_NEAR(five.values[0], -0.001468930 * 9.80665, 1e-12);
  EXPECT_NEAR(five.peak, 0.2 * 9.80665, 1e-12);
  EXPECT_EQ(eight.values.size(), 10u);
  EXPECT_EQ(eight.step, 0.02);
  EXPECT_NEAR(eight.peak, 0.8 * 9.80665, 1e-12);
  EXPECT_EQ(parse_accelerogram(kEsm, "c.asc").values, (std::vector<double>{-1, 0.5, 0.005, 0.1}));
  const Accelerogram knet = parse_accelerogram(kKnet, "d.NS");
  EXPECT_EQ(knet.step, 0.01);
  ASSERT_EQ(knet.values.size(), 4u);
  EXPECT_NEAR(knet.values[0], -1500 * 2000.0 / 8e6 * 0.01, 1e-12) << "without the mean of 2500";
  const Accelerogram named = parse_accelerogram("t [s],a [g]\n0,0.1\n0.01,-0.2\n", "e.csv");
  EXPECT_NEAR(named.peak, 0.2 * 9.80665, 1e-12);
  EXPECT_NEAR(named.step, 0.01, 1e-15);
  EXPECT_EQ(parse_accelerogram("1\n-2\n", "f.txt", {0.01, "gal"}).values, (std::vector<double>{0.01, -0.02}));
}

TEST(Accelerograms, TimesHaveTheirUnit) {
  EXPECT_NEAR(parse_accelerogram("t [ms],a [m/s^2]\n0,0.1\n10,-0.2\n20,0.1\n", "a").step, 0.01, 1e-12);
  EXPECT_NEAR(parse_accelerogram("t [min],a [g]\n0,0.1\n0.01,-0.2\n0.02,0.1\n", "a").step, 0.6, 1e-12);
  EXPECT_NE(error_of([] { parse_accelerogram("t [fortnight],a [g]\n0,1\n1,1\n", "a"); }).find("has an unknown unit"), std::string::npos);
}

TEST(Accelerograms, WhatIsWrongIsNamed) {
  const auto error = [](const std::string& text) { return error_of([&] { parse_accelerogram(text, "a"); }); };
  EXPECT_NE(error("PEER\nx\nVELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 2, DT= .02 SEC\n1 2\n").find("a:3: holds no accelerations"), std::string::npos);
  EXPECT_NE(error("PEER\nx\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 3, DT= .02 SEC\n1 2\n").find("a:4: another number of values: expected 3"), std::string::npos);
  EXPECT_NE(error("PEER\nx\nACCELERATION TIME SERIES IN UNITS OF FT\nNPTS= 2, DT= .02 SEC\n1 2\n").find("no known unit of acceleration"), std::string::npos);
  EXPECT_NE(error("PEER\nx\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 2, DT= .02 SEC\n1 x\n").find("a:5: not a number"), std::string::npos);
  EXPECT_NE(error("1\n2\n").find("has no time step"), std::string::npos);
  EXPECT_NE(error("1 2 3\n").find("not a known accelerogram"), std::string::npos);
  EXPECT_NE(error("t,a [g]\n0,1\n1,1\n3,1\n").find("a:4: unequal time steps"), std::string::npos);
}

TEST_F(DataFiles, TheHeadOfAnAccelerogramIsNoRow) {
  write("quake.at2", kPeer8);
  const Mission mission = load(
      "pile = rubble.building { cause = (function() local q = rubble.read_accelerogram('quake.at2') local n = 0 "
      "for _, row in ipairs(rubble.read_table('quake.at2').rows) do n = n + #row end print('words ' .. n) "
      "return { accelerogram = q.values, accelerogram_step = q.step, shake = q.peak } end)() }");
  const auto& cause = mission.scenario.pile.building.cause;
  EXPECT_EQ(cause.accelerogram.size(), 10u);
  EXPECT_EQ(cause.accelerogram_step, 0.02);
  EXPECT_NEAR(cause.shake, 0.8 * 9.80665, 1e-12);
  EXPECT_TRUE(printed(mission, "words 10"));
}

const char* const kKalibr =
    "cam0:\n  cam_overlaps: [1]\n  camera_model: pinhole\n  distortion_coeffs: [-0.28, 0.07, 0.0002, 1.8e-05]\n"
    "  distortion_model: radtan\n  intrinsics: [458.6, 457.3, 367.2, 248.4]\n  resolution: [752, 480]\n"
    "cam1:\n  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.11]\n  - [0.0, 1.0, 0.0, 0.0]\n  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n"
    "  camera_model: pinhole\n  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]\n  distortion_model: equidistant\n"
    "  intrinsics: [457.6, 456.1, 380.0, 255.2]\n  resolution: [752, 480]\n";
const char* const kOpenCv =
    "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
    "   data: [ 5.3e+02, 0., 3.42e+02, 0.,\n       5.31e+02, 2.35e+02, 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n"
    "   rows: 5\n   cols: 1\n   dt: d\n   data: [ -0.26, -0.038, 0.0017, -0.00028, 0.23 ]\n";

TEST_F(DataFiles, CalibrationsBecomeCameras) {
  write("chain.yaml", kKalibr);
  const Scenario s = load("cameras = rubble.read_calibration('chain.yaml').cameras").scenario;
  ASSERT_EQ(s.cameras.size(), 2u);
  EXPECT_EQ(s.cameras[0].camera.width, 752);
  EXPECT_EQ(s.cameras[0].camera.lens.model, LensKind::plumb_bob);
  EXPECT_EQ(s.cameras[0].camera.lens.p2, 1.8e-5);
  EXPECT_EQ(s.cameras[1].camera.lens.model, LensKind::fisheye);
  EXPECT_EQ(s.cameras[1].camera.lens.k4, 0.4);
  EXPECT_EQ(s.cameras[1].position, Vec3(0, -0.11, 0)) << "on the right";
  EXPECT_EQ(s.cameras[1].rpy_deg, Vec3(0, 0, 0));
  write("opencv.yaml", kOpenCv);
  const Scenario o = load("camera = rubble.read_calibration('opencv.yaml').camera").scenario;
  EXPECT_EQ(o.cameras[0].camera.height, 480);
  EXPECT_EQ(o.cameras[0].camera.lens.fy, 531);
  EXPECT_EQ(o.cameras[0].camera.lens.k3, 0.23);
  write("os.json", "{\"sensor_info\":{\"prod_line\":\"OS-0-32\"},\"config_params\":{\"lidar_mode\":\"2048x10\"}}");
  const Scenario l = load("lidars = { top = rubble.read_calibration('os.json').lidar }").scenario;
  ASSERT_EQ(l.sensors.size(), 1u);
  EXPECT_EQ(l.sensors[0].key(), "lidars.top");
  EXPECT_EQ(l.sensors[0].figures->most_points(), 32 * 2048);
}

// Of three rings, so that no model has them.
TEST(Calibrations, OfAnOusterHaveItsOwnBeams) {
  const char* const old = R"({"prod_line":"OS-1","lidar_mode":"512x20","beam_altitude_angles":[16.5,0.25,-15.75],
    "beam_azimuth_angles":[3.25,0,-3.125],"lidar_origin_to_beam_origin_mm":12.163,
    "lidar_to_sensor_transform":[-1,0,0,0,0,-1,0,0,0,0,1,36.18,0,0,0,1],"imu_to_sensor_transform":[1,0,0,6,0,1,0,-11,0,0,1,7,0,0,0,1]})";
  const char* const sections = R"({"sensor_info":{"prod_line":"OS-1"},"config_params":{"lidar_mode":"512x20",
    "azimuth_window":[0,180000],"min_range_threshold_cm":50},"lidar_data_format":{"udp_profile_lidar":"RNG19_RFL8_SIG16_NIR16_DUAL"},
    "beam_intrinsics":{"beam_altitude_angles":[16.5,0.25,-15.75],"beam_azimuth_angles":[3.25,0,-3.125],
    "beam_to_lidar_transform":[1,0,0,12.163,0,1,0,0,0,0,1,0,0,0,0,1]},
    "lidar_intrinsics":{"lidar_to_sensor_transform":[-1,0,0,0,0,-1,0,0,0,0,1,36.18,0,0,0,1]}})";
  for (const char* text : {old, sections}) {
    const SensorCalibration read = parse_calibration(text, "os.json");
    const Value& lidar = *read.keys.find("lidar");
    const auto list = [&](const char* key) {
      std::vector<double> out;
      for (const Value& item : lidar.find(key)->items) out.push_back(item.number);
      return out;
    };
    EXPECT_EQ(list("beam_elevations_deg"), (std::vector<double>{-15.75, 0.25, 16.5})) << "from the lowest";
    EXPECT_EQ(list("beam_azimuths_deg"), (std::vector<double>{3.125, 0, -3.25})) << "to the left, Ouster's to the right";
    EXPECT_NEAR(lidar.find("beam_radius")->number, 0.012163, 1e-12);
    EXPECT_NEAR(lidar.find("beam_height")->number, 0.03618, 1e-12);
    EXPECT_EQ(lidar.find("channels"), nullptr);
    EXPECT_EQ(bool(lidar.find("returns")), text == sections);
    EXPECT_EQ(bool(lidar.find("min_range")), text == sections);
    ASSERT_EQ(read.notes.size(), 1u);
    EXPECT_EQ(read.notes[0].substr(0, read.notes[0].find(' ')), text == old ? "imu_to_sensor_transform" : "azimuth_window");
  }
}

TEST(Calibrations, OfAnOusterNameWhatTheyLackOrIsLeftOut) {
  const auto notes = [](const std::string& keys) {
    std::string all;
    for (const std::string& note : parse_calibration("prod_line: OS-0-32\nlidar_mode: 1024x10\n" + keys, "os").notes) all += note + "\n";
    return all;
  };
  const std::string none = notes("");
  EXPECT_NE(none.find("beam_altitude_angles are not in the file"), std::string::npos);
  EXPECT_NE(none.find("lidar_origin_to_beam_origin_mm is not in the file"), std::string::npos);
  const std::string turned = notes("lidar_to_sensor_transform: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 36, 0, 0, 0, 1]\nsignal_multiplier: 2\n");
  EXPECT_NE(turned.find("lidar_to_sensor_transform is left out: expected 180 degrees"), std::string::npos);
  EXPECT_NE(turned.find("signal_multiplier is left out"), std::string::npos);
  // 32 of 64 rows have a laser.
  std::string rows;
  for (int i = 0; i < 64; ++i) rows += (i ? ", " : "") + std::string(i % 2 ? "0" : std::to_string(20.5 - i / 2));
  const Value lidar = *parse_calibration("prod_line: OS-1-32\nlidar_mode: 1024x10\nbeam_altitude_angles: [" + rows + "]\n", "os").keys.find("lidar");
  ASSERT_EQ(lidar.find("beam_elevations_deg")->items.size(), 32u);
  EXPECT_EQ(lidar.find("beam_elevations_deg")->items[0].number, -10.5);
}

TEST(Calibrations, WhatIsNotSimulatedIsNamed) {
  const auto error = [](const std::string& text) { return error_of([&] { parse_calibration(text, "c"); }); };
  EXPECT_NE(error("cam0:\n  camera_model: omni\n  intrinsics: [1, 2, 3, 4, 5]\n").find("`cam0.camera_model`: a model of cameras that is not simulated"), std::string::npos);
  EXPECT_NE(error("width: 4\nheight: 3\nK: [1,0,1,0,1,1,0,0,1]\nD: [1,1,1,1,1,1,1,1]\n").find("rational model"), std::string::npos);
  EXPECT_NE(error("width: 4\nheight: 3\nK: [1,0,1,0,1,1]\n").find("`camera_matrix`: another number of values: expected 9, found 6"), std::string::npos);
  EXPECT_NE(error("prod_line: OS-1-16\nlidar_mode: 1024x10\n").find("`beam_altitude_angles`: nothing tells the elevations"), std::string::npos);
  EXPECT_NE(error("prod_line: OS-1-32\nlidar_mode: 1024x10\nbeam_altitude_angles: [1, 2]\n").find("another number of rings than the sensor has: expected 32, found 2"), std::string::npos);
  EXPECT_NE(error("prod_line: OS-DOME-128\nlidar_mode: 1024x10\n").find("a sensor that is not simulated"), std::string::npos);
  EXPECT_NE(error("prod_line: OS-1\nlidar_mode: 1024x10\nbeam_altitude_angles: [1, 2]\nbeam_azimuth_angles: [1]\n").find("`beam_azimuth_angles`: another number of values: expected 2, found 1"), std::string::npos);
  EXPECT_NE(error("a: 1\n").find("is no calibration"), std::string::npos);
  EXPECT_NE(error("a: [1\nb: }").find("c:2: is neither YAML nor JSON"), std::string::npos);
  EXPECT_NE(error(std::string(1000, '[')).find("nested too deeply"), std::string::npos);
}

}  // namespace data_files_test
}  // namespace rubble
