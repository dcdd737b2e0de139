// What the master of a PROFIBUS line said last to each address and what was answered, from the moment on that somebody
// looks: a line that nobody looks at keeps no frame for it.
#pragma once

#include <array>

#include "runtime/bus/profibus/dp_service.hpp"
#include "runtime/bus/profibus/line.hpp"

namespace ipos::runtime {

struct LastDpFrames {
  profibus::Octets outputs;    // of the last Data_Exchange
  profibus::Octets inputs;     // of its answer
  profibus::Octets diagnosis;  // of the last answer to Slave_Diag
  profibus::Octets command;    // of the last Global_Control
  uint64_t requests = 0;       // all frames to it but tokens
  uint64_t answers = 0;  // all frames of it that answer; a short acknowledgement does not say whose it is
};

// Data_Exchange has no access points (EN 50170 volume 2).
inline void note_request(const profibus::FdlFrame& frame, LastDpFrames& last) {
  ++last.requests;
  if (!frame.dsap && !frame.ssap && !frame.data.empty()) last.outputs = frame.data;
  if (frame.dsap && profibus::dp_service(*frame.dsap) == profibus::DpService::GlobalControl) last.command = frame.data;
}
inline void note_answer(const profibus::FdlFrame& frame, LastDpFrames& last) {
  ++last.answers;
  if (!frame.dsap && !frame.ssap && !frame.data.empty()) last.inputs = frame.data;
  if (frame.ssap && profibus::dp_service(*frame.ssap) == profibus::DpService::SlaveDiag) last.diagnosis = frame.data;
}

class LastDpTraffic final : public profibus::LineObserver {
 public:
  explicit LastDpTraffic(profibus::Line& line) { line.add_observer(*this); }

  const LastDpFrames& of(uint8_t address) const { return last_[address & profibus::kBroadcast]; }

 private:
  void on_frame(const profibus::Line&, NodeId, const profibus::Reception& reception) override {
    if (!reception.frame || !reception.frame->has_control()) return;
    const profibus::FdlFrame& frame = *reception.frame;
    if (frame.is_request())
      note_request(frame, last_[frame.destination & profibus::kBroadcast]);
    else
      note_answer(frame, last_[frame.source & profibus::kBroadcast]);
  }
  void on_line_event(const profibus::Line&, const profibus::LineEvent&) override {}

  std::array<LastDpFrames, profibus::kBroadcast + 1> last_{};
};

}  // namespace ipos::runtime
