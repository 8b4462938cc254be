// The bytes of small TIFF files of one strip, as GDAL writes elevation models.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace rubble::testing {

class TiffBytes {
 public:
  // form: 1: unsigned, 2: signed, 3: real; samples: of each row from the top, as `bits` wide numbers
  template <typename T>
  TiffBytes(int width, int height, int form, const std::vector<T>& samples) {
    add_short(256, width), add_short(257, height), add_short(258, int(8 * sizeof(T))), add_short(259, 1), add_short(262, 1);
    add_long(273, 0);  // where the pixels begin; see bytes()
    add_short(277, 1), add_short(278, height), add_long(279, std::uint32_t(samples.size() * sizeof(T)));
    add_short(339, form);
    pixels_.assign(reinterpret_cast<const char*>(samples.data()), samples.size() * sizeof(T));
  }

  // Tags in ascending order. The size of a pixel and the place of the first one's outer corner.
  TiffBytes& ground(double pixel_x, double pixel_y, double left, double top) {
    add_doubles(33550, {pixel_x, pixel_y, 0});
    return add_doubles(33922, {0, 0, 0, left, top, 0});
  }
  // model_type: 1: projected, 2: longitude and latitude
  TiffBytes& geo_keys(int model_type, int unit = 9001) {
    const std::uint16_t keys[] = {1, 1, 0, 2, 1024, 0, 1, std::uint16_t(model_type), 3076, 0, 1, std::uint16_t(unit)};
    add(34735, 3, 12, {reinterpret_cast<const char*>(keys), sizeof keys});
    return *this;
  }
  // Units of pixels and heights; 0: the file does not say. size: of a unit of pixels that the file defines
  // (32767); below 0: the file has numbers, and none is the size.
  TiffBytes& units(int unit, int vertical, double size = 0) {
    std::string keys;
    std::uint16_t count = 1;
    const auto add_key = [&](int key, int tag, int value) {
      for (const int part : {key, tag, 1, value}) put(keys, std::uint16_t(part));
      ++count;
    };
    add_key(1024, 0, 1);
    if (unit) add_key(3076, 0, unit);
    if (size > 0) add_key(3077, 34736, 1);
    if (vertical) add_key(4099, 0, vertical);
    std::string head;
    for (const int part : {1, 1, 0, count - 1}) put(head, std::uint16_t(part));
    add(34735, 3, 4u * count, head + keys);
    return size != 0 ? add_doubles(34736, {5, size}) : *this;
  }
  // GDAL's XML.
  TiffBytes& metadata(const std::string& xml) {
    add(42112, 2, std::uint32_t(xml.size() + 1), xml + '\0');
    return *this;
  }
  TiffBytes& no_data(const std::string& text) {
    add(42113, 2, std::uint32_t(text.size() + 1), text + '\0');
    return *this;
  }

  std::string bytes() const {
    std::string head = "II*", directory, values;
    head += '\0';
    put(head, std::uint32_t(8));
    const std::uint32_t count = std::uint32_t(tags_.size()), after = 8 + 2 + 12 * count + 4;
    put(directory, std::uint16_t(count));
    for (const Tag& tag : tags_) {
      put(directory, tag.number), put(directory, tag.type), put(directory, tag.count);
      std::string value = tag.value;
      if (tag.number == 273) value.clear(), put(value, std::uint32_t(after + sizes()));
      if (value.size() <= 4) {
        directory += value + std::string(4 - value.size(), '\0');
      } else {
        put(directory, std::uint32_t(after + values.size()));
        values += value;
      }
    }
    put(directory, std::uint32_t(0));
    return head + directory + values + pixels_;
  }

 private:
  struct Tag {
    std::uint16_t number, type;
    std::uint32_t count;
    std::string value;
  };
  template <typename T>
  static void put(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void add(int number, int type, std::uint32_t count, std::string value) {
    tags_.push_back({std::uint16_t(number), std::uint16_t(type), count, std::move(value)});
  }
  void add_short(int number, int value) {
    std::string bytes;
    put(bytes, std::uint16_t(value));
    add(number, 3, 1, bytes);
  }
  void add_long(int number, std::uint32_t value) {
    std::string bytes;
    put(bytes, value);
    add(number, 4, 1, bytes);
  }
  TiffBytes& add_doubles(int number, const std::vector<double>& values) {
    add(number, 12, std::uint32_t(values.size()), {reinterpret_cast<const char*>(values.data()), 8 * values.size()});
    return *this;
  }
  std::size_t sizes() const {
    std::size_t sum = 0;
    for (const Tag& tag : tags_) sum += tag.value.size() > 4 ? tag.value.size() : 0;
    return sum;
  }

  std::vector<Tag> tags_;
  std::string pixels_;
};

}  // namespace rubble::testing
