// Messages as another library's code encodes them. Fast-CDR serializes std::array and std::vector by
// itself; the fields are those of ROS 2's message files, in their order.
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <string>
#include <vector>

#include "io/ros/ros_messages.h"

namespace rubble::test {

class FastCdr {
 public:
  FastCdr()
      : buffer_(memory_.data(), memory_.size()),
        cdr_(buffer_, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS, Version::DDS_CDR) {
    cdr_.serialize_encapsulation();
  }

  template <typename T>
  FastCdr& operator<<(const T& value) {
    cdr_ << value;
    return *this;
  }
  FastCdr& stamp(std::int64_t ns) {
    return *this << static_cast<std::int32_t>(ns / 1000000000)
                 << static_cast<std::uint32_t>(ns % 1000000000);
  }
  FastCdr& header(const ros::Header& h) { return stamp(h.stamp_ns) << h.frame; }
  FastCdr& vector(const Vec3& v) { return *this << v.x << v.y << v.z; }
  FastCdr& pose(const Pose& p) {
    const Quat& q = p.rotation;
    return vector(p.translation) << q.x << q.y << q.z << q.w;
  }
#if FASTCDR_VERSION_MAJOR >= 2  // Debian 13
  std::string bytes() const { return {buffer_.getBuffer(), cdr_.get_serialized_data_length()}; }

 private:
  using Version = eprosima::fastcdr::CdrVersion;
#else
  std::string bytes() const { return {buffer_.getBuffer(), cdr_.getSerializedDataLength()}; }

 private:
  using Version = eprosima::fastcdr::Cdr;
#endif
  std::vector<char> memory_ = std::vector<char>(4096);  // zeros: Fast-CDR leaves padding as it is
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

}  // namespace rubble::test
