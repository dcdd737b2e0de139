// The receiver, one character at a time.
#include "runtime/bus/profibus/fdl_receiver.hpp"

#include <utility>

namespace ipos::profibus {

void FdlReceiver::finish(tl::expected<FdlFrame, FrameError> frame, std::vector<Reception>& receptions) {
  receptions.push_back({std::move(frame), std::exchange(octets_, {}), start_, quiet_since_});
}

void FdlReceiver::fail(FrameError error, std::vector<Reception>& receptions) {
  skipping_ = true;
  finish(tl::unexpected(error), receptions);
}

std::vector<Reception> FdlReceiver::take(const runtime::Character& character) {
  std::vector<Reception> receptions;
  // Before the first character of all the line counts as having been quiet.
  const Time pause = heard_ ? character.start - quiet_since_ : runtime::kSecond;
  heard_ = true;
  if (receiving() && pause > limits_.gap) fail(FrameError::Gap, receptions);
  quiet_since_ = character.end;
  if (skipping_ && pause < limits_.resync) return receptions;
  skipping_ = false;
  if (!receiving()) {
    start_ = character.start;
    idle_before_ = pause;
  }
  octets_.push_back(character.data);
  if (character.parity_error || character.framing_error) {
    fail(character.framing_error ? FrameError::Framing : FrameError::Parity, receptions);
    return receptions;
  }
  const auto size = frame_size(octets_);
  if (!size) {
    fail(size.error(), receptions);
  } else if (*size && octets_.size() == **size) {
    auto frame = decode(octets_);
    if (!frame)
      fail(frame.error(), receptions);
    else if (limits_.idle != 0 && frame->needs_idle() && idle_before_ < limits_.idle)
      fail(FrameError::Idle, receptions);
    else
      finish(std::move(frame), receptions);
  }
  return receptions;
}

}  // namespace ipos::profibus
