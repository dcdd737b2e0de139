// The time of silence, counted in ticks.
#include "runtime/drive/link_watch.hpp"

namespace ipos::runtime {

bool LinkWatch::on_process_data(bool restarts) {
  seen_ = true;
  return restarts && on_request();
}

bool LinkWatch::on_request() {
  const bool was_silent = reported_;
  running_ = true;
  reported_ = false;
  silent_ms_ = 0;
  return was_silent;
}

bool LinkWatch::run() {
  running_ = true;
  ++silent_ms_;
  // A telegram may have come right before the first tick, so that tick counts for nothing: never early, at
  // most a millisecond late.
  if (silent_ms_ <= rules_.delay_ms) return false;
  if (!rules_.supervised) {
    forget();
    return false;
  }
  reported_ = true;
  return true;
}

}  // namespace ipos::runtime
