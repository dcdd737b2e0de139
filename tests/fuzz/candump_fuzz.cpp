// Any text to the log reader: a place of the first error, or frames that are written and read as the same.
#include "runtime/bus/log/bus_load.hpp"
#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/movilink/describe.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::runtime;  // NOLINT
using namespace ipos::tests;    // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto log = parse_candump(text_of(data, size));
  if (!log) {
    require(log.error().line > 0 && log.error().column > 0 && log.error().column <= size + 1 &&
                !log.error().message.empty(),
            "an error has a place and a text");
    return 0;
  }
  BusLoad load;
  for (const LogEntry& entry : *log) {
    load.add(entry.time, entry.frame);
    require(!describe({}, entry.frame).text.empty(), "every frame has a description");
    require(is_valid(entry.frame), "a frame that was read can be sent");
    const auto again = parse_candump_line(candump_line(entry.time, entry.bus, entry.frame));
    require(again.has_value() && *again == entry, "a written line is read as the same frame");
  }
  require(load.total().frames == log->size(), "every frame is counted");
  return 0;
}
