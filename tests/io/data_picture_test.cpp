// Pictures whose pixels are numbers, and colour pictures of 16 bits.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/image/data_picture.h"
#include "io/image/exr_file.h"
#include "io/image/image_file.h"
#include "io/image/picture_decoder.h"
#include "kernel/base/error.h"
#include "tests/io/tiff_bytes.h"

namespace rubble::testing {
namespace data_picture_test {

std::string refusal_of(const std::string& bytes) {
  try {
    decode_data_picture(bytes);
  } catch (const RunError& error) {
    return error.what();
  }
  return "read";
}

TEST(DataPicture, SixteenBitsStayLinear) {
  const DataPicture data = decode_data_picture(encode_png(DepthImage{5, 1, {0, 16384, 32768, 49152, 65535}}));
  EXPECT_EQ(data.values, (std::vector<float>{0, 16384, 32768, 49152, 65535}));
  EXPECT_EQ(data.white, 65535);
  // As a colour: half of white is half of 255.
  const RgbaImage colour = decode_picture(encode_png(DepthImage{3, 1, {0, 32768, 65535}}));
  EXPECT_EQ(colour.rgba, (std::vector<std::uint8_t>{0, 0, 0, 255, 128, 128, 128, 255, 255, 255, 255, 255}));
}

// glTF: what an image says of its colour space is ignored.
TEST(DataPicture, GammaOfAPngChangesNoTexture) {
  std::string png = encode_png(RgbImage{1, 1, {200, 100, 50}});
  png.insert(33, std::string("\0\0\0\x04gAMA\0\x01\x86\xa0\x31\xe8\x96\x5f", 16));  // 1.0, behind IHDR
  EXPECT_EQ(decode_picture(png).rgba, (std::vector<std::uint8_t>{200, 100, 50, 255}));
}

TEST(DataPicture, EightBitsAndColoursAreTheirStoredValues) {
  EXPECT_EQ(decode_data_picture(encode_png(GrayImage{3, 1, {0, 128, 255}})).values, (std::vector<float>{0, 128, 255}));
  const DataPicture rgb = decode_data_picture(encode_png(RgbImage{2, 1, {90, 90, 90, 0, 255, 0}}));
  EXPECT_TRUE(rgb.colour);
  EXPECT_EQ(rgb.values[0], 90);
  EXPECT_NEAR(rgb.values[1], 0.7152 * 255, 1e-3);
  const std::vector<std::uint8_t> grey(8 * 8 * 3, 77);
  const DataPicture jpeg = decode_data_picture(encode_jpeg(8, 8, grey.data(), 95));
  EXPECT_EQ(jpeg.values.size(), 64u);
  EXPECT_NEAR(jpeg.values[20], 77, 1);
  EXPECT_FALSE(jpeg.colour);
}

TEST(DataPicture, PgmOfBothKindsAndSizes) {
  const std::vector<float> expected{0, 256, 65535};
  EXPECT_EQ(decode_data_picture("P2\n# made by hand\n3 1\n65535\n0 256 65535\n").values, expected);
  EXPECT_EQ(decode_data_picture(std::string("P5 3 1 65535\n\0\0\1\0\xff\xff", 19)).values, expected);
  EXPECT_NE(refusal_of("P5 3 1 255\nab").find("ends too early"), std::string::npos);
  EXPECT_NE(refusal_of("P2 2 1 255\n1 256\n").find("not a whole image"), std::string::npos);
}

TEST(DataPicture, OtherNetpbmFormats) {
  const DataPicture ppm = decode_data_picture("P3 2 1 255 90 90 90 0 255 0\n");
  EXPECT_TRUE(ppm.colour);
  EXPECT_EQ(ppm.values[0], 90);
  EXPECT_NEAR(ppm.values[1], 0.7152 * 255, 1e-3);
  const std::vector<float> bits{1, 0, 0};
  EXPECT_EQ(decode_data_picture("P1\n3 1\n011").values, bits) << "1 is black";
  EXPECT_EQ(decode_data_picture("P4 3 1 \x60").values, bits);
  EXPECT_EQ(decode_data_picture("P4 3 1 \x60").white, 1);
  // Rows from the bottom; both orders of bytes.
  const DataPicture big = decode_data_picture(std::string("Pf\n1 2\n1.0\n\x3f\x80\0\0\x40\0\0\0", 19));
  EXPECT_EQ(big.values, (std::vector<float>{2, 1}));
  EXPECT_EQ(big.white, 0) << "numbers, not grey levels";
  EXPECT_EQ(decode_data_picture(std::string("Pf\n1 1\n-1\n\0\0\x80\x3f", 14)).values, (std::vector<float>{1}));
  EXPECT_NE(refusal_of("Pf\n1 1\n-1\nab").find("is a damaged PFM: the file ends too early"), std::string::npos);
}

// head: from the number of bits on; after the header of 40 bytes come palette or masks, and the pixels.
std::string bmp(int width, int height, int bits, int compression, const std::string& palette, const std::string& pixels) {
  const auto number = [](int value, int bytes) {
    std::string out;
    for (int k = 0; k < bytes; ++k) out += char(unsigned(value) >> (8 * k));
    return out;
  };
  return "BM" + number(0, 4) + number(0, 4) + number(54 + int(palette.size()), 4) + number(40, 4) + number(width, 4) + number(height, 4) +
         number(1, 2) + number(bits, 2) + number(compression, 4) + std::string(20, '\0') + palette + pixels;
}

TEST(DataPicture, BmpOfEveryNumberOfBits) {
  const std::string two("\x0a\x0a\x0a\0\xc8\xc8\xc8\0", 8);  // grey of 10 and 200
  const std::vector<float> expected{200, 10, 200};
  const auto values = [&](int bits, int compression, const std::string& palette, const std::string& pixels) {
    return decode_data_picture(bmp(3, 1, bits, compression, palette, pixels)).values;
  };
  EXPECT_EQ(values(1, 0, two, std::string("\xa0\0\0\0", 4)), expected);
  EXPECT_EQ(values(4, 0, two, std::string("\x10\x10\0\0", 4)), expected);
  EXPECT_EQ(values(8, 0, two, std::string("\1\0\1\0", 4)), expected);
  EXPECT_EQ(values(8, 1, two, std::string("\0\3\1\0\1\0\0\1", 8)), expected) << "absolute";
  EXPECT_EQ(values(8, 1, two, std::string("\1\1\1\0\1\1\0\0\0\1", 10)), expected) << "runs";
  EXPECT_EQ(values(4, 2, two, std::string("\3\x10\0\1", 4)), expected) << "a run of two colours";
  EXPECT_EQ(values(24, 0, "", "\xc8\xc8\xc8\x0a\x0a\x0a\xc8\xc8\xc8" + std::string(3, '\0')), expected);
  EXPECT_EQ(values(32, 0, "", std::string("\xc8\xc8\xc8\0\x0a\x0a\x0a\0\xc8\xc8\xc8\0", 12)), expected);
  const std::string masks("\0\xf8\0\0\xe0\7\0\0\x1f\0\0\0", 12);  // 5, 6 and 5 bits
  EXPECT_EQ(values(16, 3, masks, std::string("\xff\xff\0\0\0\0\0\0", 8)), (std::vector<float>{255, 0, 0}));
}

TEST(DataPicture, BmpBeginsAtTheBottomUnlessItsHeightIsNegative) {
  const std::string pixels("\1\1\1\0\2\2\2\0", 8);
  EXPECT_EQ(decode_data_picture(bmp(1, 2, 24, 0, "", pixels)).values, (std::vector<float>{2, 1}));
  EXPECT_EQ(decode_data_picture(bmp(1, -2, 24, 0, "", pixels)).values, (std::vector<float>{1, 2}));
  EXPECT_EQ(decode_data_picture(bmp(1, 2, 24, 0, "", pixels)).white, 255);
  EXPECT_NE(refusal_of(bmp(1, 2, 24, 0, "", pixels.substr(1))).find("is a damaged BMP: the file ends too early"), std::string::npos);
  EXPECT_EQ(refusal_of(bmp(16000, 16000, 8, 1, "", "")), "has more than 64 million pixels");
  EXPECT_NE(refusal_of(bmp(1, 1, 24, 4, "", pixels)).find("JPEG inside"), std::string::npos);
  EXPECT_NE(refusal_of(bmp(2, 1, 8, 1, "", std::string("\3\1\0\1", 4))).find("not a whole image"), std::string::npos);
}

TEST(DataPicture, TiffOfIntegersAndRealNumbers) {
  EXPECT_EQ(decode_data_picture(TiffBytes(2, 1, 1, std::vector<std::uint16_t>{7, 65535}).bytes()).white, 65535);
  const DataPicture sign = decode_data_picture(TiffBytes(2, 1, 2, std::vector<std::int16_t>{-5, 900}).bytes());
  EXPECT_EQ(sign.values, (std::vector<float>{-5, 900}));
  EXPECT_EQ(sign.white, 0) << "numbers, not grey levels";
  const DataPicture real = decode_data_picture(TiffBytes(1, 2, 3, std::vector<double>{0.25, 1e3}).bytes());
  EXPECT_EQ(real.values, (std::vector<float>{0.25, 1e3}));
  EXPECT_FALSE(real.ground);
}

TEST(DataPicture, GeoTiffKeepsItsScaleAndPlace) {
  const std::string bytes = TiffBytes(2, 2, 3, std::vector<float>{1, 2, -9999, 4})
                                .ground(30, 30, 500000, 4100000).geo_keys(1).no_data("-9999").bytes();
  const DataPicture data = decode_data_picture(bytes);
  ASSERT_TRUE(data.ground);
  EXPECT_EQ(data.ground->pixel_x, 30);
  EXPECT_EQ(data.ground->left, 500000);
  EXPECT_EQ(data.ground->top, 4100000);
  EXPECT_FALSE(data.ground->degrees);
  EXPECT_TRUE(std::isnan(data.values[2]));
  EXPECT_EQ(data.values[3], 4);
  const auto degrees = TiffBytes(1, 1, 2, std::vector<std::int16_t>{3}).ground(0.0003, 0.0003, 8, 47).geo_keys(2);
  EXPECT_TRUE(decode_data_picture(degrees.bytes()).ground->degrees);
}

TEST(DataPicture, UnitsOfAGeoTiffBecomeMetres) {
  const auto tiff = [](int unit, int vertical, double size = 0) {
    return TiffBytes(1, 1, 2, std::vector<std::int16_t>{3}).ground(2, 2, 8, 47).units(unit, vertical, size).bytes();
  };
  const struct {
    int unit, vertical;
    double size, pixel, height;
  } cases[] = {{0, 0, 0, 2, 3}, {9001, 0, 0, 2, 3}, {9036, 0, 0, 2000, 3}, {9001, 9002, 0, 2, 0.9144},
               {9002, 9001, 0, 0.6096, 3}, {9003, 9003, 0, 2400.0 / 3937, 3600.0 / 3937},
               {9005, 9001, 0, 0.6095945308, 3}, {9014, 9014, 0, 3.6576, 5.4864},
               {9030, 9001, 0, 3704, 3}, {9035, 9001, 0, 3218.694437389, 3}, {9037, 9001, 0, 1.8287835924, 3},
               {9040, 9001, 0, 1.828796829, 3}, {9041, 9001, 0, 0.609598943, 3}, {9093, 9096, 0, 3218.688, 2.7432},
               {32767, 9001, 0.5, 1, 3}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.unit);
    const DataPicture data = decode_data_picture(tiff(c.unit, c.vertical, c.size));
    ASSERT_TRUE(data.ground);
    EXPECT_NEAR(data.ground->pixel_x, c.pixel, 1e-6);
    EXPECT_NEAR(data.ground->top, c.pixel / 2 * 47, 1e-4);
    EXPECT_NEAR(data.values[0], c.height, 1e-6);
  }
  const auto refused = [&](int unit, int vertical, const char* why, double size = 0) {
    const std::string refusal = refusal_of(tiff(unit, vertical, size));
    EXPECT_NE(refusal.find(why), std::string::npos) << refusal;
  };
  refused(9062, 9001, "whose ProjLinearUnits (key 3076) is not known: expected the EPSG code of a length");
  refused(9001, 9102, "whose VerticalUnits (key 4099) is not known");
  refused(32767, 9001, "found 32767 without its size");
  refused(32767, 9001, "found 32767 without its size", -1);
  refused(9003, 0, "without VerticalUnits (key 4099)");
}

TEST(DataPicture, ScaleAndOffsetOfATiffAreApplied) {
  const auto tiff = [](const std::string& items) {
    return TiffBytes(2, 1, 2, std::vector<std::int16_t>{30, -1}).ground(2, 2, 8, 47)
        .metadata("<GDALMetadata>" + items + "</GDALMetadata>").no_data("-1").bytes();
  };
  const std::string scale = "<Item name=\"SCALE\" sample=\"0\" role=\"scale\">",
                    other = "<Item name=\"SCALE\" sample=\"1\" role=\"scale\">9</Item>";
  const DataPicture data = decode_data_picture(
      tiff("<Item name=\"A\">7</Item>" + scale + "0.5</Item>" +
           "<Item name=\"OFFSET\" sample=\"0\" role=\"offset\">100</Item>" + other));
  EXPECT_EQ(data.values[0], 115);
  EXPECT_TRUE(std::isnan(data.values[1])) << "no value is no height";
  const std::string refusal = refusal_of(tiff(scale + "x</Item>"));
  EXPECT_NE(refusal.find("have a bad scale: expected a number other than 0, found `x`"), std::string::npos) << refusal;
}

TEST(DataPicture, OpenExrOfOneChannelOrColours) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const DataPicture height = decode_data_picture(encode_exr(3, 1, {"Y"}, {-2.5f, none, 1234.5f}));
  EXPECT_EQ(height.values[0], -2.5f);
  EXPECT_TRUE(std::isnan(height.values[1]));
  EXPECT_EQ(height.values[2], 1234.5f);
  EXPECT_EQ(height.white, 0) << "numbers, not grey levels";
  EXPECT_EQ(decode_data_picture(encode_exr(1, 2, {"Z"}, {3, 4})).values, (std::vector<float>{3, 4}));
  const DataPicture colours = decode_data_picture(encode_exr(2, 1, {"R", "G", "B"}, {1, 1, 1, 0, 1, 0}));
  EXPECT_EQ(colours.values[0], 1);
  EXPECT_NEAR(colours.values[1], 0.7152, 1e-6);
  EXPECT_TRUE(colours.colour);
  EXPECT_NE(refusal_of(encode_exr(1, 1, {"U", "V"}, {1, 2})).find("found U, V"), std::string::npos);
  const std::string whole = encode_exr(3, 1, {"Y"}, {1, 2, 3});
  EXPECT_NE(refusal_of(whole.substr(0, whole.size() - 4)).find("is a damaged OpenEXR picture"), std::string::npos);
}

TEST(DataPicture, WhatIsNotReadIsNamed) {
  const std::string read = "PNG, JPEG, TIFF, OpenEXR, WebP, BMP, PGM, PPM, PBM and PFM are read";
  EXPECT_EQ(refusal_of("GIF89a"), "is a GIF picture; " + read + ": convert it");
  EXPECT_EQ(refusal_of("P7\nWIDTH 1\n"), "is a PAM picture; " + read + ": convert it");
  EXPECT_EQ(refusal_of("heights"), "is no picture; " + read);
  EXPECT_EQ(refusal_of(std::string("RIFF\0\0\0\0WEBPVP8 ", 16)), "is a damaged WebP: no good header");
  EXPECT_EQ(picture_kind("P1 = 3"), "") << "Lua";
  EXPECT_EQ(picture_kind("P2P networks are text"), "");
  EXPECT_EQ(picture_kind("BMW"), "");
  const std::string whole = TiffBytes(2, 2, 3, std::vector<float>{1, 2, 3, 4}).bytes();
  EXPECT_NE(refusal_of(whole.substr(0, whole.size() - 4)).find("is a damaged TIFF"), std::string::npos);
  EXPECT_NE(refusal_of(whole.substr(0, 20)).find("is a damaged TIFF"), std::string::npos);
  EXPECT_NE(refusal_of("\x89PNG\r\n\x1a\n....").find("is a damaged PNG"), std::string::npos);
}

}  // namespace data_picture_test
}  // namespace rubble::testing
