// The log that a run writes: the buses of a plant into a file of a form.
#pragma once

#include <memory>
#include <ostream>
#include <string>

#include "runtime/plant/plant.hpp"
#include "tools/logs/writing/writer.hpp"

namespace ipos::tools {

// By the ending of the file's name (tools/cli/output_forms.hpp), which is known. The stream must outlive it.
std::unique_ptr<LogWriter> make_log_writer(const std::string& path, std::ostream& out);

// The buses of a plant into a log.
class PlantLog final : private runtime::CanObserver,
                       private runtime::SerialObserver,
                       private profibus::LineObserver {
 public:
  // Both must outlive it.
  PlantLog(runtime::Plant& plant, LogWriter& writer);
  PlantLog(const PlantLog&) = delete;
  PlantLog& operator=(const PlantLog&) = delete;

  // At the end of a run: telegrams that were not completed.
  void finish();
  // The form holds CAN only, and the plant has buses of other kinds only.
  bool stays_empty() const { return stays_empty_; }

 private:
  void on_frame(const runtime::CanLine& line, const runtime::FrameRecord& record) override;
  void on_error_frame(const runtime::CanLine& line, const runtime::ErrorRecord& record) override {
    writer_.can_error(line, record);
  }
  void on_line_event(const runtime::CanLine&, const runtime::LineEvent&) override {}
  void on_character(const runtime::Rs485Line& line, runtime::NodeId sender,
                    const runtime::Character& character) override;
  void on_serial_event(const runtime::Rs485Line&, const runtime::SerialEvent&) override {}
  void on_frame(const profibus::Line& line, profibus::NodeId sender,
                const profibus::Reception& reception) override;
  void on_line_event(const profibus::Line&, const profibus::LineEvent&) override {}

  LogWriter& writer_;
  bool stays_empty_;
  std::map<std::string, runtime::SerialReceiver> receivers_;  // by line
};

}  // namespace ipos::tools
