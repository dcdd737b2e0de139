// The one place where a signal of a station is made.
#include "runtime/signals/collector.hpp"

#include <fmt/format.h>

namespace ipos::signals {

Signal& Collector::add(Group group, std::string_view name, std::string_view meaning, std::function<int64_t()> read) {
  const bool hidden = !names_.emplace(name).second;
  Signal& signal = found.emplace_back();
  signal.station = owner_.station.config().name;
  signal.name = fmt::format("{}.{}{}", signal.station, hidden ? kUnitPrefix : "", name);
  signal.group = group;
  signal.meaning = meaning;
  signal.read = std::move(read);
  signal.owner = owner_.to_write;
  return signal;
}

}  // namespace ipos::signals
