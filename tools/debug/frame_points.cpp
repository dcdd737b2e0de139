// Patterns of frames: digits, # and wildcards.
#include "tools/debug/frame_points.hpp"

#include <fmt/format.h>

#include "runtime/signals/find.hpp"

namespace ipos::tools::debug {

bool FramePoints::is_frame(const runtime::Plant& plant, std::string_view pattern) {
  for (const auto& bus : plant.buses())
    if (pattern.starts_with(bus->name() + " ")) pattern.remove_prefix(bus->name().size() + 1);
  constexpr std::string_view kDigits = "0123456789ABCDEF#";
  return !plant.buses().empty() && pattern.find_first_of(kDigits) != std::string_view::npos &&
         pattern.find_first_not_of("0123456789ABCDEF#R*? ") == std::string_view::npos;
}

void FramePoints::built(runtime::Plant& plant) {
  plant_ = &plant;
  for (const auto& bus : plant.buses()) bus->add_observer(*this);
}

bool FramePoints::remove(int id) {
  return std::erase_if(points_, [id](const FramePoint& point) { return point.id == id; }) != 0;
}

void FramePoints::listen(bool forward) {
  forward_ = forward;
  seen_.clear();
}

void FramePoints::on_message(const runtime::Bus& bus, const runtime::BusMessage& message) {
  if (!forward_ || has_seen()) return;
  for (FramePoint& point : points_) {
    if (!point.enabled ||
        (!signals::matches(point.pattern, message.text) && !signals::matches(point.pattern, bus.name() + " " + message.text)))
      continue;
    std::string wrong;
    try {
      if (!point.condition.empty() && evaluate(*plant_, 0, point.condition) == 0) continue;
      if (!hits_hold(*plant_, 0, point.hit_condition, ++point.hits)) continue;
    } catch (const ValueError& error) {  // its user sees it
      wrong = fmt::format(": {}", error.what());
    }
    id_ = point.id;
    seen_ = fmt::format("{} on {}{}", message.text, bus.name(), wrong);
    return;
  }
}

}  // namespace ipos::tools::debug
