// ipos bus decode: a log of any form, or bare RS-485 telegrams, in words and units.
#include <fmt/format.h>

#include <optional>
#include <set>

#include "compiler/diag/places.hpp"
#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/log/serial_log.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/bus/log_input.hpp"
#include "tools/bus/telegram_json.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

struct DecodeFlags {
  LogFlags log;
  NamesFlags names;
  std::string format = "text";
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

// Telegrams of every kind of bus. The names of a plant are looked up when they are first needed.
class Decoder {
 public:
  explicit Decoder(const DecodeFlags& flags) : flags_(flags), json_(flags.format == "json") {}

  void take(const runtime::LogEntry& entry, LogPlace place) {
    const runtime::Description description = words().describe(entry.bus, entry.frame);
    if (json_) return print(telegram_json(entry), description.text);
    fmt::print("{} {} {}\n", time_text(entry), compiler::printable(entry.bus), description.text);
    if (description.known || !unknown_.emplace(entry.frame.extended, entry.frame.id).second) return;
    if (place.line != 0) place.column = identifier_column(entry);
    fmt::print(stderr, "{}: note: nothing is known about identifier {}\n", place_text(flags_.log.path, place),
               runtime::id_words(entry.frame.id, entry.frame.extended));
  }
  void take(const runtime::SerialEntry& entry) {
    const std::string text = words().describe(entry.reception);
    if (json_) return print(telegram_json(entry), text);
    if (entry.time)
      fmt::print("{} {} ", runtime::serial_time_text(*entry.time), compiler::printable(entry.line));
    fmt::print("{}\n", text);
  }
  void take(const runtime::ProfibusEntry& entry) {
    const std::string text = words().describe(entry.line, entry.reception);
    if (json_) return print(telegram_json(entry), text);
    if (!entry.line.empty())
      fmt::print("{} {} ", runtime::serial_time_text(entry.reception.start), compiler::printable(entry.line));
    fmt::print("{}\n", text);
  }

 private:
  runtime::BusWords& words() {
    if (!words_) words_.emplace(bus_names_of(flags_.names));
    return *words_;
  }
  // In ASCII: names come from strangers, and the output may be a terminal.
  static void print(nlohmann::ordered_json fields, const std::string& text) {
    fields["text"] = text;
    fmt::print("{}\n", fields.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  }

  const DecodeFlags& flags_;
  bool json_;
  std::optional<runtime::BusWords> words_;
  std::set<std::pair<bool, uint32_t>> unknown_;
};

int decode(const DecodeFlags& flags) {
  Decoder decoder(flags);
  LogFindings findings(flags.log.path);
  read_log_file(flags.log, findings,
                {[&](const runtime::LogEntry& entry, LogPlace place) { decoder.take(entry, place); },
                 [&](const runtime::SerialEntry& entry, LogPlace) { decoder.take(entry); },
                 [&](const runtime::ProfibusEntry& entry, LogPlace) { decoder.take(entry); },
                 {}});
  return findings.finish() ? kGood : kBadInput;
}

}  // namespace

void add_bus_decode(cli::Verb& bus) {
  auto flags = std::make_shared<DecodeFlags>();
  cli::Verb& verb = bus.verb("decode", "telegrams of a log in words and units");
  add_log_options(
      verb, flags->log,
      "log: candump, pcap, pcapng, ASC, TRC, BLF, of --serial-log, or RS-485 telegrams in hexadecimal, "
      "also packed with gzip; - is standard input");
  verb.option("--format", flags->format, "text, or json: an object a telegram, a line each")
      .one_of({"text", "json"});
  add_names_options(verb, flags->names);
  verb.footer("Example:\n  ipos bus decode can.log --names examples/scom/scom.toml");
  verb.runs([flags] { return decode(*flags); });
}

}  // namespace ipos::tools
