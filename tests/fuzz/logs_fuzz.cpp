// Any bytes to the readers of other tools' logs (candump, serial, pcap, pcapng, ASC, TRC, BLF): each mistake has a place in the
// file and a text, and what is read is written in every form and read as the same frames.
#include <algorithm>
#include <sstream>

#include "tests/fuzz/fuzz.hpp"
#include "tools/logs/fields.hpp"
#include "tools/logs/log_forms.hpp"
#include "tools/logs/log_writer.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tools;  // NOLINT
using namespace ipos::tests;  // NOLINT

namespace {

using runtime::Time;

struct Taken {
  std::vector<runtime::LogEntry> can;
  std::vector<runtime::SerialEntry> serial;
  std::vector<runtime::ProfibusEntry> dp;
  size_t mistakes = 0;
};

Taken taken(std::string_view log) {
  const LogForm form = log_form(log);
  const bool binary = form != LogForm::Lines && form != LogForm::Asc && form != LogForm::Trc;
  const auto lines = static_cast<size_t>(std::count(log.begin(), log.end(), '\n')) + 1;
  const auto in_log = [&](LogPlace place) {
    require(binary
                ? place.line == 0 && place.column <= log.size()
                : place.line > 0 && place.line <= lines && place.column > 0 && place.column <= log.size() + 1,
            "a place is in the log");
  };
  Taken all;
  const LogReader reader{[&](const runtime::LogEntry& entry, LogPlace place) {
                           in_log(place);
                           require(is_valid(entry.frame), "a frame that was read can be sent");
                           all.can.push_back(entry);
                         },
                         [&](const runtime::SerialEntry& entry, LogPlace place) {
                           in_log(place);
                           all.serial.push_back(entry);
                         },
                         [&](const runtime::ProfibusEntry& entry, LogPlace place) {
                           in_log(place);
                           all.dp.push_back(entry);
                         },
                         [&](LogPlace place, const std::string& message) {
                           in_log(place);
                           require(!message.empty() && !place_text("a.log", place).empty(),
                                   "a mistake has a text");
                           ++all.mistakes;
                         },
                         [](LeftOut) {},
                         [&](LogPlace place, const std::string&) { in_log(place); }};
  read_log(log, reader);
  if (const auto unpacked = unpacked_log(log))
    require(unpacked->bytes.size() <= std::max(size_t{1} << 20U, 32 * log.size()),
            "a packed log is bounded by its size");
  return all;
}

bool is_in_a_log(Time time) { return time >= 0 && time < kLongestLog; }

std::string one_line(const runtime::ProfibusEntry& entry) {
  runtime::EventQueue queue(1);
  const profibus::Line line(queue, 0, entry.line.empty() ? "l" : entry.line, 9'600);
  std::ostringstream out;
  runtime::ProfibusLog(out).on_frame(line, 0, entry.reception);
  return out.str();
}

// Telegrams and frames of PROFIBUS, as they are read again.
void same(const Taken& first, const Taken& again) {
  require(again.mistakes == 0, "what is written is a log without mistakes");
  require(again.serial.size() == first.serial.size(), "every telegram is written");
  for (size_t n = 0; n < first.serial.size(); ++n) {
    const runtime::Reception &before = first.serial[n].reception, &after = again.serial[n].reception;
    require(std::ranges::equal(before.bytes.span(), after.bytes.span()), "a telegram keeps its bytes");
    require(before.telegram == after.telegram, "a telegram that was read is read as the same");
  }
  require(again.dp.size() == first.dp.size(), "every frame of PROFIBUS is written");
  for (size_t n = 0; n < first.dp.size(); ++n) {
    const profibus::Reception &before = first.dp[n].reception, &after = again.dp[n].reception;
    require(before.octets == after.octets, "a frame keeps its octets");
    require(before.frame.has_value() == after.frame.has_value(), "a frame stays one, and a void one void");
    require(before.frame || before.frame.error() == after.frame.error(), "a void frame keeps its reason");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const Taken first = taken(text_of(data, size));
  // Before virtual time 0, and later than a log may last, nothing is written.
  for (const runtime::LogEntry& entry : first.can)
    if (!is_in_a_log(entry.time)) return 0;
  for (const runtime::SerialEntry& entry : first.serial)
    if (!is_in_a_log(entry.reception.start) || !is_in_a_log(entry.reception.end)) return 0;
  for (const runtime::ProfibusEntry& entry : first.dp)
    if (!is_in_a_log(entry.reception.start) || !is_in_a_log(entry.reception.end)) return 0;
  std::ostringstream lines;
  for (const runtime::SerialEntry& entry : first.serial)
    lines << serial_log_line(entry.line.empty() ? "l" : entry.line, entry.reception) << '\n';
  for (const runtime::ProfibusEntry& entry : first.dp) lines << one_line(entry);
  same(first, taken(lines.str()));
  for (const char* name : {"a.log", "a.pcapng", "a.asc", "a.trc"}) {
    std::ostringstream out;
    {
      const auto writer = make_log_writer(name, out);
      for (const runtime::LogEntry& entry : first.can) writer->can(entry.time, entry.bus, entry.frame);
      for (const runtime::SerialEntry& entry : first.serial) writer->serial(entry.line, entry.reception);
      for (const runtime::ProfibusEntry& entry : first.dp) writer->dp(entry.line, entry.reception);
      if (writer->has_serial()) same(first, taken(out.str()));
    }
    const Taken again = taken(out.str());
    require(again.mistakes == 0, "what is written is a log without mistakes");
    require(again.can.size() == first.can.size(), "every frame is written");
    for (size_t n = 0; n < first.can.size(); ++n)
      require(again.can[n].frame == first.can[n].frame, "a written frame is read as the same");
  }
  return 0;
}
