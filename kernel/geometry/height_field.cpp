#include "kernel/geometry/height_field.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/model/range_check.h"

namespace rubble {
namespace {

class Maker {
 public:
  Maker(const HeightField& field, double depth) : field_(field) {
    const double lowest = *std::min_element(field.heights.begin(), field.heights.end());
    bottom_ = field.origin.z + lowest - depth;
  }

  TriangleMesh make() {
    const int columns = field_.columns, rows = field_.rows;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) add(column, row, height(column, row));
    }
    for (int row = 0; row + 1 < rows; ++row) {
      for (int column = 0; column + 1 < columns; ++column) {
        const std::uint32_t a = number(column, row), b = a + 1, d = number(column, row + 1),
                            c = d + 1;
        mesh_.triangles.push_back({a, b, c});
        mesh_.triangles.push_back({a, c, d});
      }
    }
    std::vector<std::uint32_t> rim;  // counter-clockwise seen from above
    for (int i = 0; i + 1 < columns; ++i) rim.push_back(number(i, 0));
    for (int i = 0; i + 1 < rows; ++i) rim.push_back(number(columns - 1, i));
    for (int i = columns - 1; i > 0; --i) rim.push_back(number(i, rows - 1));
    for (int i = rows - 1; i > 0; --i) rim.push_back(number(0, i));
    add_walls(rim);
    return std::move(mesh_);
  }

 private:
  std::uint32_t number(int column, int row) const {
    return std::uint32_t(row) * std::uint32_t(field_.columns) + std::uint32_t(column);
  }
  double height(int column, int row) const {
    return field_.origin.z + field_.heights[number(column, row)];
  }
  void add(int column, int row, double z) {
    mesh_.positions.push_back(Vec3f(Vec3{field_.origin.x + column * field_.spacing,
                                         field_.origin.y + row * field_.spacing, z}));
  }

  // The bottom is a fan about its middle, so that it needs no more corners than the walls have.
  void add_walls(const std::vector<std::uint32_t>& rim) {
    const auto first = std::uint32_t(mesh_.positions.size());
    const auto count = std::uint32_t(rim.size());
    for (const std::uint32_t top : rim) {
      Vec3f p = mesh_.positions[top];
      p.z = float(bottom_);
      mesh_.positions.push_back(p);
    }
    const std::uint32_t middle = first + count;
    mesh_.positions.push_back(Vec3f(
        Vec3{field_.origin.x + (field_.columns - 1) * field_.spacing * 0.5,
             field_.origin.y + (field_.rows - 1) * field_.spacing * 0.5, bottom_}));
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t next = (i + 1) % count;
      mesh_.triangles.push_back({rim[i], first + i, first + next});
      mesh_.triangles.push_back({rim[i], first + next, rim[next]});
      mesh_.triangles.push_back({first + next, first + i, middle});
    }
  }

  const HeightField& field_;
  double bottom_ = 0;
  TriangleMesh mesh_;
};

}  // namespace

void HeightField::validate(const char* key) const {
  RangeCheck check(key);
  check.expect(columns >= 2 && columns <= 1024, ".columns", "2 to 1024", columns);
  check.expect(rows >= 2 && rows <= 1024, ".rows", "2 to 1024", rows);
  check.expect(spacing >= 0.01 && spacing <= 100, ".spacing", "0.01 to 100 m", spacing);
  check.expect(heights.size() == std::size_t(std::max(0, columns)) * std::size_t(std::max(0, rows)),
               ".heights", "columns * rows of them", double(heights.size()));
  check.expect(std::all_of(heights.begin(), heights.end(),
                           [](double h) { return std::isfinite(h) && std::abs(h) <= 1000; }),
               ".heights", "numbers between -1000 and 1000", double(heights.size()));
  check.finish();
}

TriangleMesh make_height_field_mesh(const HeightField& field, double depth,
                                    const std::string& surface) {
  field.validate("heights");
  TriangleMesh mesh = Maker(field, depth).make();
  mesh.surface_names = {surface};
  mesh.surfaces.assign(mesh.triangles.size(), 0);
  return mesh;
}

}  // namespace rubble
