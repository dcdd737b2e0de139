// PROFIBUS lines in the log of serial lines (serial_log.hpp): one frame a line with begin and end in seconds of virtual
// time, line, octets and meaning; what was no frame with its octets and the reason.
//
//   0.003455 0.003653 dp 68 05 05 68 88 81 6D 3C 3E F0 16 | 1 -> 8 Slave_Diag, SRD high, FCB 1
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/bus/profibus/line.hpp"

namespace ipos::runtime {

class ProfibusLog final : public profibus::LineObserver {
 public:
  explicit ProfibusLog(std::ostream& out) : out_(out) {}

  void on_frame(const profibus::Line& line, profibus::NodeId sender,
                const profibus::Reception& reception) override;
  void on_line_event(const profibus::Line&, const profibus::LineEvent&) override {}

 private:
  std::ostream& out_;
};

// What a frame says, or why there is none.
std::string reception_text(const profibus::Reception& reception);

// A line of the log, or a bare frame.
struct ProfibusEntry {
  std::string line;  // of a bare frame empty
  profibus::Reception reception;
};

// What was heard, from its octets: a frame, or why there is none. `error` is that of the receiver, who also sees what is
// not in the octets (parity, gaps); without one the octets tell.
profibus::Reception reception_of(profibus::Octets octets, Time start, Time end,
                                 std::optional<profibus::FrameError> error);

// Nothing for what is of another kind of line: no octets, or octets that begin no frame.
std::optional<ProfibusEntry> parse_profibus_line(std::string_view text);

}  // namespace ipos::runtime
