#include "io/live/simulation_services.h"

#include <cmath>

namespace rubble::simulation_services {
namespace {

// A quaternion of zeros, as messages that are not filled have, is no rotation: the caller says what that means.
Pose read_pose(WireCursor& body, bool& valid) {
  Pose pose;
  double values[7];
  valid = true;
  for (double& value : values) {
    value = body.number<double>();
    valid = valid && std::isfinite(value);
  }
  pose.translation = {values[0], values[1], values[2]};
  const Quat q{values[6], values[3], values[4], values[5]};
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  valid = valid && std::abs(square - 1) < 0.02;
  if (valid) pose.rotation = normalized(q);
  return pose;
}

void put(ros::Wire& wire, const Vec3& v) {
  for (const double value : {v.x, v.y, v.z}) wire.number(value);
}

}  // namespace

Filters read_filters(WireCursor& body) {
  Filters filters;
  filters.pattern = body.text();
  for (std::size_t i = body.count(1); i > 0; --i) filters.categories.push_back(body.number<std::uint8_t>());
  for (std::size_t i = body.count(4); i > 0; --i) filters.tags.push_back(body.text());
  filters.all_tags = body.number<std::uint8_t>() != 0;
  filters.bounds.type = body.number<std::uint8_t>();
  for (std::size_t i = body.count(24); i > 0; --i) filters.bounds.points.push_back(body.vector());
  body.end();
  return filters;
}

SetStateRequest read_set_state(WireCursor& body) {
  SetStateRequest request;
  request.entity = body.text();
  const WireCursor::Header header = body.header();
  request.state.stamp_ns = header.stamp_ns, request.state.frame = header.frame;
  request.state.pose = read_pose(body, request.state.valid_pose);
  request.state.linear = body.vector();
  request.state.angular = body.vector();
  body.vector(), body.vector();  // the acceleration
  request.pose = body.number<std::uint8_t>() != 0;
  request.twist = body.number<std::uint8_t>() != 0;
  request.acceleration = body.number<std::uint8_t>() != 0;
  body.end();
  return request;
}

SpawnRequest read_spawn(WireCursor& body) {
  SpawnRequest request;
  request.name = body.text();
  request.allow_renaming = body.number<std::uint8_t>() != 0;
  request.uri = body.text();
  request.resource_string = body.text();
  request.entity_namespace = body.text();
  request.frame = body.header().frame;
  request.pose = read_pose(body, request.valid_pose);
  body.end();
  return request;
}

void put(ros::Wire& wire, const Result& result) {
  wire.number(result.code);
  wire.text(result.message);
}

void put(ros::Wire& wire, const std::vector<std::string>& texts) {
  wire.count(texts.size());
  for (const std::string& text : texts) wire.text(text);
}

void put(ros::Wire& wire, const EntityState& state) {
  wire.time(state.stamp_ns);
  wire.text(state.frame);
  put(wire, state.pose.translation);
  const Quat& q = state.pose.rotation;
  for (const double value : {q.x, q.y, q.z, q.w}) wire.number(value);
  put(wire, state.linear), put(wire, state.angular);
  put(wire, Vec3{}), put(wire, Vec3{});  // accelerations, which are not known
}

}  // namespace rubble::simulation_services
