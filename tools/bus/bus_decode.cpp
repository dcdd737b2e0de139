// ipos bus decode: a candump log, a log of RS-485 lines or bare RS-485 telegrams in words and units.
#include <fmt/format.h>

#include <optional>
#include <set>

#include "compiler/diag/places.hpp"
#include "runtime/bus/log/serial_log.hpp"
#include "runtime/bus/movilink/describe_serial.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

struct DecodeFlags {
  std::string log;
  NamesFlags names;
};

// "(0946684800.000102)" as in the log, so that a line can be found again.
std::string time_text(const runtime::LogEntry& entry) {
  const std::string line = runtime::candump_line(entry.time, entry.bus, {});
  return line.substr(0, line.find(' '));
}

// Column of the identifier in a line as candump writes it; what is known of a line that read well.
size_t identifier_column(const runtime::LogEntry& entry) {
  return time_text(entry).size() + entry.bus.size() + 3;
}

// Both kinds of lines, each with the dictionary of its bus: that of a plant is made when it is first needed.
class Decoder {
 public:
  explicit Decoder(const DecodeFlags& flags) : flags_(flags) {}

  std::optional<runtime::LogError> take(std::string_view row, size_t line) {
    if (runtime::is_serial_line(row)) {
      const auto entry = runtime::parse_serial_line(row, line);
      if (!entry) return entry.error();
      show(*entry);
      return std::nullopt;
    }
    const auto entry = runtime::parse_candump_line(row, line);
    if (!entry) return entry.error();
    show(*entry, line);
    return std::nullopt;
  }

 private:
  void show(const runtime::LogEntry& entry, size_t line) {
    if (!words_) words_.emplace(can_names_of(flags_.names));
    const runtime::Description description = words_->describe(entry.bus, entry.frame);
    fmt::print("{} {} {}\n", time_text(entry), compiler::printable(entry.bus), description.text);
    if (!description.known && unknown_.emplace(entry.frame.extended, entry.frame.id).second)
      fmt::print(stderr, "{}:{}:{}: note: nothing is known about identifier {}{}\n", flags_.log, line,
                 identifier_column(entry), entry.frame.id, entry.frame.extended ? " (29 bits)" : "");
  }
  void show(const runtime::SerialEntry& entry) {
    if (!serial_names_) serial_names_ = serial_names_of(flags_.names.plant, flags_.names.compile);
    if (entry.time)
      fmt::print("{} {} ", runtime::serial_time_text(*entry.time), compiler::printable(entry.line));
    fmt::print("{}\n", runtime::describe(*serial_names_, entry.reception));
  }

  const DecodeFlags& flags_;
  std::optional<runtime::CanWords> words_;
  std::optional<runtime::TelegramNames> serial_names_;
  std::set<std::pair<bool, uint32_t>> unknown_;
};

int decode(const DecodeFlags& flags) {
  Decoder decoder(flags);
  const size_t bad =
      read_lines(flags.log, [&](std::string_view row, size_t line) { return decoder.take(row, line); });
  return bad == 0 ? kGood : kBadInput;
}

}  // namespace

void add_bus_decode(cli::Verb& bus) {
  auto flags = std::make_shared<DecodeFlags>();
  cli::Verb& verb = bus.verb("decode", "telegrams of a candump log or of RS-485 in words and units");
  verb.option("LOG", flags->log,
              "candump log, log of --serial-log, or RS-485 telegrams in hexadecimal; - is standard input")
      .required();
  add_names_options(verb, flags->names);
  verb.footer("Example:\n  ipos bus decode can.log --names examples/scom/scom.toml");
  verb.runs([flags] { return decode(*flags); });
}

}  // namespace ipos::tools
