// Ours to MRPT's: for the two recorders that write its objects, and for no other file.
#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/io/CStream.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>

#include <cstdint>
#include <string>

#include "render/scene/frame.h"

namespace rubble {

// MRPT serializes into memory. Its own file streams swallow the errors of closing a file, so the
// bytes go to the disk through AtomicFile, one gzip member a frame.
class MemoryStream : public mrpt::io::CStream {
 public:
  std::size_t Write(const void* data, std::size_t size) override {
    bytes_.append(static_cast<const char*>(data), size);
    return size;
  }
  std::size_t Read(void*, std::size_t) override;                    // throws: write-only
  std::uint64_t Seek(std::int64_t, CStream::TSeekOrigin) override;  // likewise
  std::uint64_t getTotalBytesCount() const override { return bytes_.size(); }
  std::uint64_t getPosition() const override { return bytes_.size(); }
  std::string getStreamDescription() const override { return "memory"; }

  const std::string& bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }  // keeps its memory for the next frame

 private:
  std::string bytes_;
};

mrpt::Clock::time_point mrpt_time(std::int64_t stamp_ns);
mrpt::poses::CPose3D mrpt_pose(const Pose& pose);
mrpt::img::TCamera mrpt_camera(const Intrinsics& k);

}  // namespace rubble
