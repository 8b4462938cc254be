#include "io/datasets/reading_recorder.h"

#include "io/base/folder_writer.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

class ReadingRecorder : public Recorder {
 public:
  ReadingRecorder(const std::string& path, const Recording& recording) : recording_(recording), folder_(path, {}, 1) {
    for (const SensorRecord& sensor : recording_.sensors) {
      std::string head = "#stamp [ns]";
      for (const ReadingColumn& column : sensor.format->columns())
        head += "," + column.name + (column.unit.empty() ? "" : " [" + column.unit + "]");
      tables_.push_back(sensor.scans() ? "" : head + "\n");
    }
  }

  void write(const Frame&) override {}
  void write_reading(const Reading& reading) override {
    if (reading.scan) return;
    std::string& table = tables_.at(std::size_t(reading.sensor));
    table += std::to_string(reading.stamp_ns);
    for (const double value : reading.values) table += "," + exact_text(value);
    table += "\n";
  }
  void finish() override {
    for (std::size_t i = 0; i < tables_.size(); ++i)
      if (!tables_[i].empty()) folder_.write(recording_.sensors[i].name + ".csv", tables_[i]);
    folder_.finish();
  }

 private:
  Recording recording_;
  FolderWriter folder_;
  std::vector<std::string> tables_;
};

}  // namespace

std::unique_ptr<Recorder> make_reading_recorder(const std::string& path, const Recording& recording) {
  return std::make_unique<ReadingRecorder>(path, recording);
}

}  // namespace rubble
