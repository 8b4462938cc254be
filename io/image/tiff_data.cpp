// TIFF and GeoTIFF by libtiff. GDAL reads the same tags, with a hundred libraries behind it.
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>

#include "io/image/data_picture.h"
#include "io/image/picture_decoder.h"
#include "io/base/text_scan.h"
#include "kernel/base/error.h"
#include "kernel/base/system/disk_cache.h"
#include "kernel/base/system/isolated_worker.h"
#include "kernel/base/tables/text_table.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

// OGC GeoTIFF 1.1, and GDAL's tags: its XML about the channels, and what stands for no value.
constexpr std::uint32_t kPixelScaleTag = 33550, kTiepointTag = 33922, kTransformTag = 34264, kGeoKeysTag = 34735,
                        kGeoDoublesTag = 34736, kMetadataTag = 42112, kNoDataTag = 42113;
constexpr std::uint16_t kModelTypeKey = 1024, kLinearUnitKey = 3076, kLinearSizeKey = 3077, kVerticalUnitKey = 4099;
constexpr std::uint16_t kGeographic = 2, kMetre = 9001, kKilometre = 9036, kUserDefined = 32767;

struct LengthUnit {
  std::uint16_t code = 0;  // of EPSG
  double metres = 0;
};
constexpr LengthUnit kLengthUnits[] = {{kMetre, 1},
                                       {9002, 0.3048},                  // foot
                                       {9003, 1200.0 / 3937},           // US survey foot
                                       {9005, 0.3047972654},            // Clarke's foot
                                       {9014, 1.8288},                  // fathom
                                       {9030, 1852},                    // nautical mile
                                       {9035, 5280 * 1200.0 / 3937},    // US survey mile
                                       {kKilometre, 1000},
                                       {9037, 3 * 0.3047972654},        // Clarke's yard
                                       {9040, 36 / 39.370147},          // British yard of Sears 1922
                                       {9041, 12 / 39.370147},          // British foot of Sears 1922
                                       {9093, 1609.344},                // statute mile
                                       {9096, 0.9144}};                 // yard
constexpr tmsize_t kMostTiffMemory = tmsize_t(1) << 30;  // of one allocation; unit: byte

struct TiffSource {
  std::string_view bytes;
  std::uint64_t at = 0;
  std::string error;
};

TiffSource& source_of(thandle_t handle) { return *static_cast<TiffSource*>(handle); }
tmsize_t take_tiff(thandle_t handle, void* data, tmsize_t size) {
  TiffSource& s = source_of(handle);
  if (s.at >= s.bytes.size() || size <= 0) return 0;
  const std::size_t count = std::min(std::size_t(size), s.bytes.size() - std::size_t(s.at));
  std::memcpy(data, s.bytes.data() + s.at, count);
  s.at += count;
  return tmsize_t(count);
}
tmsize_t refuse_tiff_write(thandle_t, void*, tmsize_t) { return 0; }
toff_t seek_tiff(thandle_t handle, toff_t offset, int whence) {
  TiffSource& s = source_of(handle);
  s.at = whence == SEEK_SET ? offset : whence == SEEK_CUR ? s.at + offset : s.bytes.size() + offset;
  return s.at;
}
int close_tiff(thandle_t) { return 0; }
toff_t size_of_tiff(thandle_t handle) { return source_of(handle).bytes.size(); }

int keep_tiff_error(TIFF*, void* user, const char*, const char* format, va_list values) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, values);
  auto& error = static_cast<TiffSource*>(user)->error;
  if (error.empty()) error = text;
  return 1;
}
int ignore_tiff_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

class TiffFile {
 public:
  explicit TiffFile(std::string_view bytes) {
    source_.bytes = bytes;
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, kMostTiffMemory);
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_tiff_error, &source_);
    TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_tiff_warning, &source_);
    tiff_ = TIFFClientOpenExt("picture", "rm", &source_, take_tiff, refuse_tiff_write, seek_tiff, close_tiff, size_of_tiff,
                              nullptr, nullptr, options);
    TIFFOpenOptionsFree(options);
    if (!tiff_) fail();
  }
  ~TiffFile() {
    if (tiff_) TIFFClose(tiff_);
  }
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  DataPicture read();

 private:
  [[noreturn]] void fail() const {
    throw RunError("is a damaged TIFF" + (source_.error.empty() ? "" : ": " + source_.error));
  }
  [[noreturn]] static void decline(const std::string& what) {
    throw RunError("is a TIFF " + what + "; one channel or RGB of 8, 16, 32 or 64 bits is read. Save it as such, or as PNG");
  }

  std::uint16_t short_tag(std::uint32_t tag, std::uint16_t fallback) const {
    std::uint16_t value = fallback;
    return TIFFGetFieldDefaulted(tiff_, tag, &value) ? value : fallback;
  }
  std::vector<double> doubles_tag(std::uint32_t tag) const;
  std::string text_tag(std::uint32_t tag) const;
  std::optional<std::uint16_t> find_geo_key(std::uint16_t key, std::uint16_t tag) const;
  std::uint16_t geo_key(std::uint16_t key) const { return find_geo_key(key, 0).value_or(std::uint16_t(0)); }
  double metres_of(std::uint16_t key, const char* name, double user_defined) const;
  void read_form();
  double sample(const unsigned char* at) const;
  float pixel(const unsigned char* row, std::size_t x) const;
  void read_tiles(DataPicture& out);
  void read_strips(DataPicture& out);
  void read_ground(DataPicture& out) const;
  void read_units(PictureGround& ground, DataPicture& out) const;
  void mask_no_data(DataPicture& out) const;
  void apply_scale(DataPicture& out) const;

  TiffSource source_;
  TIFF* tiff_ = nullptr;
  std::uint32_t width_ = 0, height_ = 0;
  std::uint16_t bits_ = 1, channels_ = 1, form_ = SAMPLEFORMAT_UINT, colours_ = PHOTOMETRIC_MINISBLACK;
  bool contiguous_ = true;
};

void TiffFile::read_form() {
  TIFFGetField(tiff_, TIFFTAG_IMAGEWIDTH, &width_);
  TIFFGetField(tiff_, TIFFTAG_IMAGELENGTH, &height_);
  check_picture_size(width_, height_);
  bits_ = short_tag(TIFFTAG_BITSPERSAMPLE, 1);
  channels_ = short_tag(TIFFTAG_SAMPLESPERPIXEL, 1);
  form_ = short_tag(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  if (form_ == SAMPLEFORMAT_VOID) form_ = SAMPLEFORMAT_UINT;
  colours_ = short_tag(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  contiguous_ = short_tag(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_CONTIG;
  if (colours_ == PHOTOMETRIC_YCBCR && short_tag(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_JPEG) {
    TIFFSetField(tiff_, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    colours_ = PHOTOMETRIC_RGB;
  }
  const bool real = form_ == SAMPLEFORMAT_IEEEFP;
  const bool fits = real ? bits_ == 32 || bits_ == 64 : bits_ == 8 || bits_ == 16 || bits_ == 32;
  if (!fits || (!real && form_ != SAMPLEFORMAT_UINT && form_ != SAMPLEFORMAT_INT))
    decline("of " + std::to_string(bits_) + "-bit samples");
  if (colours_ != PHOTOMETRIC_MINISBLACK && colours_ != PHOTOMETRIC_MINISWHITE && colours_ != PHOTOMETRIC_RGB)
    decline("with a palette or other colours");
  if (colours_ == PHOTOMETRIC_RGB && (channels_ < 3 || !contiguous_)) decline("of separate colours");
}

double TiffFile::sample(const unsigned char* at) const {
  const auto as = [at](auto value) {
    std::memcpy(&value, at, sizeof value);
    return double(value);
  };
  if (form_ == SAMPLEFORMAT_IEEEFP) return bits_ == 64 ? as(double{}) : as(float{});
  const bool sign = form_ == SAMPLEFORMAT_INT;
  if (bits_ == 8) return sign ? as(std::int8_t{}) : as(std::uint8_t{});
  if (bits_ == 16) return sign ? as(std::int16_t{}) : as(std::uint16_t{});
  return sign ? as(std::int32_t{}) : as(std::uint32_t{});
}

float TiffFile::pixel(const unsigned char* row, std::size_t x) const {
  const std::size_t size = bits_ / 8, step = size * (contiguous_ ? channels_ : 1);
  const unsigned char* at = row + x * step;
  if (colours_ != PHOTOMETRIC_RGB) return float(sample(at));
  const double r = sample(at), g = sample(at + size), b = sample(at + 2 * size);
  return float(r == g && g == b ? r : 0.2126 * r + 0.7152 * g + 0.0722 * b);
}

void TiffFile::read_strips(DataPicture& out) {
  std::vector<unsigned char> row(std::size_t(TIFFScanlineSize64(tiff_)));
  if (row.size() < std::size_t(width_) * (bits_ / 8) * (contiguous_ ? channels_ : 1)) fail();
  for (std::uint32_t y = 0; y < height_; ++y) {
    if (TIFFReadScanline(tiff_, row.data(), y, 0) != 1) fail();
    for (std::size_t x = 0; x < width_; ++x) out.values.push_back(pixel(row.data(), x));
  }
}

void TiffFile::read_tiles(DataPicture& out) {
  std::uint32_t tile_width = 0, tile_height = 0;
  TIFFGetField(tiff_, TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(tiff_, TIFFTAG_TILELENGTH, &tile_height);
  if (tile_width == 0 || tile_height == 0 || tile_width > 65536 || tile_height > 65536) fail();
  std::vector<unsigned char> tile(std::size_t(TIFFTileSize64(tiff_)));
  const std::size_t row = std::size_t(tile_width) * (bits_ / 8) * (contiguous_ ? channels_ : 1);
  if (tile.size() < row * tile_height) fail();
  out.values.resize(std::size_t(width_) * height_);
  for (std::uint32_t top = 0; top < height_; top += tile_height)
    for (std::uint32_t left = 0; left < width_; left += tile_width) {
      if (TIFFReadTile(tiff_, tile.data(), left, top, 0, 0) < 0) fail();
      for (std::uint32_t y = top; y < std::min(height_, top + tile_height); ++y)
        for (std::uint32_t x = left; x < std::min(width_, left + tile_width); ++x)
          out.values[std::size_t(y) * width_ + x] = pixel(tile.data() + (y - top) * row, x - left);
    }
}

std::vector<double> TiffFile::doubles_tag(std::uint32_t tag) const {
  std::uint32_t count = 0;
  const double* values = nullptr;
  const TIFFField* field = TIFFFindField(tiff_, tag, TIFF_ANY);
  if (!field || TIFFFieldDataType(field) != TIFF_DOUBLE || !TIFFFieldPassCount(field)) return {};
  if (!TIFFGetField(tiff_, tag, &count, &values) || !values) return {};
  return {values, values + count};
}

std::string TiffFile::text_tag(std::uint32_t tag) const {
  std::uint32_t count = 0;
  const char* text = nullptr;
  const TIFFField* field = TIFFFindField(tiff_, tag, TIFF_ANY);
  if (!field || TIFFFieldDataType(field) != TIFF_ASCII || !TIFFFieldPassCount(field)) return {};
  if (!TIFFGetField(tiff_, tag, &count, &text) || !text) return {};
  return {text, strnlen(text, count)};
}

// tag: 0: the key has the value itself; else the tag of the values, among which the answer is the place of the key's.
std::optional<std::uint16_t> TiffFile::find_geo_key(std::uint16_t key, std::uint16_t tag) const {
  std::uint32_t count = 0;
  const std::uint16_t* values = nullptr;
  const TIFFField* field = TIFFFindField(tiff_, kGeoKeysTag, TIFF_ANY);
  if (!field || TIFFFieldDataType(field) != TIFF_SHORT || !TIFFFieldPassCount(field)) return std::nullopt;
  if (!TIFFGetField(tiff_, kGeoKeysTag, &count, &values) || !values || count < 4) return std::nullopt;
  for (std::uint32_t i = 4; i + 3 < count; i += 4)
    if (values[i] == key && values[i + 1] == tag) return values[i + 3];
  return std::nullopt;
}

// user_defined: metres of a unit that the file itself defines; not above 0: it defines none.
double TiffFile::metres_of(std::uint16_t key, const char* name, double user_defined) const {
  const std::uint16_t code = geo_key(key);
  if (code == 0) return 1;
  if (code == kUserDefined && user_defined > 0 && std::isfinite(user_defined)) return user_defined;
  for (const LengthUnit& unit : kLengthUnits)
    if (unit.code == code) return unit.metres;
  throw RunError("is a GeoTIFF whose " + std::string(name) + " (key " + std::to_string(key) +
                 ") is not known: expected the EPSG code of a length, such as 9001 (metre) or 9003 (US survey foot), "
                 "found " + std::to_string(code) + (code == kUserDefined ? " without its size" : "") +
                 "; convert it to metres");
}

// Pixels and heights in metres.
void TiffFile::read_units(PictureGround& ground, DataPicture& out) const {
  if (!ground.degrees) {
    const std::uint16_t code = geo_key(kLinearUnitKey);
    const bool metric = code == 0 || code == kMetre || code == kKilometre;
    if (!metric && geo_key(kVerticalUnitKey) == 0)
      throw RunError("is a GeoTIFF with ProjLinearUnits (key 3076) of " + std::to_string(code) +
                     " and without VerticalUnits (key 4099), so that its heights may be in feet or metres: expected "
                     "9001 (metre), 9003 (US survey foot) or another EPSG code there; set it, or convert the file to "
                     "metres");
    const std::vector<double> sizes = doubles_tag(kGeoDoublesTag);
    const auto place = find_geo_key(kLinearSizeKey, std::uint16_t(kGeoDoublesTag));
    const double metres = metres_of(kLinearUnitKey, "ProjLinearUnits", place && *place < sizes.size() ? sizes[*place] : 0);
    for (double* length : {&ground.pixel_x, &ground.pixel_y, &ground.left, &ground.top}) *length *= metres;
  }
  const double metres = metres_of(kVerticalUnitKey, "VerticalUnits", 0);
  if (metres != 1)
    for (float& value : out.values) value = float(double(value) * metres);
}

void TiffFile::read_ground(DataPicture& out) const {
  const std::vector<double> scale = doubles_tag(kPixelScaleTag), tie = doubles_tag(kTiepointTag),
                            transform = doubles_tag(kTransformTag);
  PictureGround ground;
  if (scale.size() >= 2 && tie.size() >= 6) {
    ground = {scale[0], scale[1], tie[3] - tie[0] * scale[0], tie[4] + tie[1] * scale[1], false};
  } else if (transform.size() >= 8) {
    if (transform[1] != 0 || transform[4] != 0) throw RunError("is a GeoTIFF that is turned; save it with north up");
    ground = {transform[0], -transform[5], transform[3], transform[7], false};
  } else {
    return;
  }
  if (!(ground.pixel_x > 0) || !(ground.pixel_y > 0) || !std::isfinite(ground.left) || !std::isfinite(ground.top))
    throw RunError("is a GeoTIFF whose pixels have no size; save it with north up");
  ground.degrees = geo_key(kModelTypeKey) == kGeographic;
  read_units(ground, out);
  out.ground = ground;
}

void TiffFile::mask_no_data(DataPicture& out) const {
  const std::string word = text_tag(kNoDataTag);
  const auto none = parse_number(trimmed(word));
  if (!none) return;
  for (float& value : out.values)
    if (value == float(*none)) value = std::numeric_limits<float>::quiet_NaN();
}

// What GDAL's metadata say of the first channel: <Item name="SCALE" sample="0" role="scale">0.1</Item>, and OFFSET.
void TiffFile::apply_scale(DataPicture& out) const {
  double scale = 1, offset = 0;
  const std::string metadata = text_tag(kMetadataTag);
  std::string role;
  for (XmlScanner tags(metadata); tags.next();) {
    if (!tags.closes()) {
      const std::string sample = tags.attribute("sample");
      role = sample.empty() || sample == "0" ? tags.attribute("role") : "";
    } else if (role == "scale" || role == "offset") {
      const std::string text = tags.text();
      const auto value = parse_number(trimmed(text));
      if (!value || !std::isfinite(*value) || (role == "scale" && *value == 0))
        throw RunError("is a GeoTIFF whose metadata (tag 42112) have a bad " + role + ": expected a number" +
                       (role == "scale" ? " other than 0" : "") + ", found `" + printable(trimmed(text)) +
                       "`; correct it by gdal_edit");
      (role == "scale" ? scale : offset) = *value;
      role.clear();
    }
  }
  if (scale == 1 && offset == 0) return;
  for (float& value : out.values) value = float(double(value) * scale + offset);
}

DataPicture TiffFile::read() {
  read_form();
  DataPicture out;
  out.width = int(width_), out.height = int(height_);
  const bool levels = form_ == SAMPLEFORMAT_UINT && bits_ <= 16;
  if (levels) out.white = std::ldexp(1.0, bits_) - 1;
  TIFFIsTiled(tiff_) ? read_tiles(out) : read_strips(out);
  out.colour = colours_ == PHOTOMETRIC_RGB;
  if (colours_ == PHOTOMETRIC_MINISWHITE && levels)
    for (float& value : out.values) value = float(out.white) - value;
  mask_no_data(out);
  const bool on_map = doubles_tag(kPixelScaleTag).size() >= 2 || doubles_tag(kTransformTag).size() >= 8;
  if (on_map || out.white == 0) apply_scale(out);  // grey levels have no unit
  read_ground(out);
  return out;
}

void put(CacheWriter& writer, const DataPicture& picture) {
  writer.put(picture.width), writer.put(picture.height), writer.put(picture.values);
  writer.put(picture.white), writer.put(picture.colour);
  writer.put(picture.ground.value_or(PictureGround{}));
}

}  // namespace

// In the child: the refusal, then the picture.
static std::string answer_tiff(const std::string& bytes) {
  std::vector<char> refusal;
  DataPicture picture;
  try {
    picture = TiffFile(bytes).read();
  } catch (const RunError& error) {
    refusal.assign(error.what(), error.what() + std::strlen(error.what()));
  }
  CacheWriter writer;
  writer.put(refusal);
  put(writer, picture);
  return writer.bytes();
}

DataPicture decode_tiff_data(std::string_view bytes) {
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
  static IsolatedWorker worker("TIFF", answer_tiff);  // until an input ends it
#else
  IsolatedWorker worker("TIFF", answer_tiff);
#endif
  const std::string answer = worker.ask("the picture", std::string(bytes));
  CacheReader reader(answer);
  std::vector<char> refusal;
  DataPicture picture;
  PictureGround ground;
  reader.get(refusal);
  reader.get(picture.width), reader.get(picture.height), reader.get(picture.values);
  reader.get(picture.white), reader.get(picture.colour), reader.get(ground);
  if (!reader.whole()) throw RunError("was cut short between two processes");
  if (!refusal.empty()) throw RunError(std::string(refusal.begin(), refusal.end()));
  if (ground.pixel_x > 0) picture.ground = ground;
  return picture;
}

}  // namespace rubble
