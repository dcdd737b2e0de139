// `ipos run --trace-hash`: one number over everything a run did, to compare runs, builds and engines. Two
// runs with the same number had, in every millisecond, the same variables, tasks, drives and outputs, and the
// same frames and characters at the same times.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/plant/plant.hpp"

namespace ipos::tools {

// FNV-1a, 64 bits, over numbers of 64 bits instead of bytes.
class TraceHash final : public runtime::CanObserver, public runtime::SerialObserver {
 public:
  // Watches the buses of the plant, which must outlive it.
  explicit TraceHash(runtime::Plant& plant);

  // For Plant::run_until: takes the state at whole milliseconds, after all that happened at that time.
  void sample(runtime::Time now);

  std::string text() const;  // 16 hexadecimal digits

 private:
  void on_frame(const runtime::CanLine& line, const runtime::FrameRecord& record) override;
  void on_line_event(const runtime::CanLine& line, const runtime::LineEvent& event) override;
  void on_character(const runtime::Rs485Line& line, runtime::NodeId sender,
                    const runtime::Character& character) override;
  void on_serial_event(const runtime::Rs485Line& line, const runtime::SerialEvent& event) override;

  void add(uint64_t value) { hash_ = (hash_ ^ value) * 0x100000001B3; }
  void add_text(const std::string& text);
  void add_station(runtime::Station& station);
  template <typename... Values>
  void add_all(Values... values) {
    (add(static_cast<uint64_t>(values)), ...);
  }

  runtime::Plant& plant_;
  uint64_t hash_ = 0xCBF29CE484222325;
};

}  // namespace ipos::tools
