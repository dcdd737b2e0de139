// Which telegrams of the trace a question wants: those of a line, those that a filter takes, and of an identifier that is
// paused those that came before.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tools/serve/host/bus_traffic.hpp"
#include "tools/serve/host/trace_filter.hpp"

namespace ipos::tools::serve {

class TraceChoice {
 public:
  using Monitors = std::vector<std::unique_ptr<LineMonitor>>;

  // Of the members bus, filter and paused. All three must outlive it.
  TraceChoice(const Monitors& monitors, const BusSource& source, const Arguments& arguments);

  const std::optional<uint8_t>& line() const { return line_; }  // nothing: all
  bool needs_words() const { return filter_.needs_words(); }
  bool takes(const NumberedTelegram& one) const;

 private:
  struct Paused {
    uint8_t bus;
    uint32_t id;
    bool extended, remote;
    uint64_t since;
  };

  const Monitors& monitors_;
  const BusSource& source_;
  std::optional<uint8_t> line_;
  TraceFilter filter_;
  std::vector<Paused> paused_;
};

// A Mistake: there is none.
uint8_t line_number(const TraceChoice::Monitors& monitors, const std::string& name);

}  // namespace ipos::tools::serve
