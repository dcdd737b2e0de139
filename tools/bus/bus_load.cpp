// ipos bus load: load of a log in windows of one second and by identifier.
#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/log/bus_load.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/bus/profibus_load.hpp"
#include "tools/cli/exit_codes.hpp"

namespace ipos::tools {
namespace {

using runtime::BusLoad;
using runtime::LoadCount;
using runtime::Time;

struct LoadFlags {
  std::string log;
  uint32_t baud = 0;
  std::string format = "text";
  NamesFlags names;
};

// What an identifier is for, where a plant or --canopen tells.
using Meaning = std::function<std::string(const runtime::LoggedIdentifier&)>;

Meaning meaning_of(const NamesFlags& flags) {
  return [names = can_names_of(flags)](const runtime::LoggedIdentifier& id) {
    return id.extended ? std::string() : runtime::identifier_text(names.all, names.canopen, id.id);
  };
}

std::string percent(uint64_t bits, uint32_t baud, Time span) {
  const uint64_t hundredths = LoadCount::percent_hundredths(bits, baud, span);
  return fmt::format("{}.{:02}", hundredths / 100, hundredths % 100);
}

std::string row(const std::string& what, const LoadCount& count, uint32_t baud, Time span) {
  return fmt::format("{:<12} {:>8} {:>10} {:>10} {:>8} {:>8}\n", what, count.frames, count.exact_bits,
                     count.worst_bits, percent(count.exact_bits, baud, span),
                     percent(count.worst_bits, baud, span));
}

std::string seconds(Time time) {
  const Time stamp = time + runtime::kCandumpEpoch;
  return fmt::format("{}.{:03}", stamp / runtime::kSecond, stamp % runtime::kSecond / runtime::kMillisecond);
}

std::string name_of(const runtime::LoggedIdentifier& id) { return runtime::id_text(id.id, id.extended); }

// With its meaning behind a row.
std::string with_meaning(std::string row, const std::string& meaning) {
  if (!meaning.empty()) row.insert(row.size() - 1, "  " + meaning);
  return row;
}

std::string text_report(const BusLoad& load, uint32_t baud, const Meaning& meaning) {
  std::string text = fmt::format("{:<12} {:>8} {:>10} {:>10} {:>8} {:>8}\n", "window from", "frames",
                                 "bits exact", "bits worst", "% exact", "% worst");
  for (const runtime::LoadWindow& window : load.windows())
    text += row(seconds(window.start), window.count, baud, runtime::kSecond);
  text += row("all", load.total(), baud, load.span());
  text += "\nidentifier\n";
  for (const auto& [id, count] : load.identifiers())
    text += with_meaning(row(name_of(id), count, baud, load.span()), meaning(id));
  return text;
}

nlohmann::ordered_json json_row(const LoadCount& count, uint32_t baud, Time span) {
  const auto share = [&](uint64_t bits) {
    return static_cast<double>(LoadCount::percent_hundredths(bits, baud, span)) / 100;
  };
  return {{"frames", count.frames},
          {"data_bits", count.data_bits},
          {"exact_bits", count.exact_bits},
          {"worst_bits", count.worst_bits},
          {"exact_percent", share(count.exact_bits)},
          {"worst_percent", share(count.worst_bits)}};
}

std::string json_report(const BusLoad& load, uint32_t baud, const Meaning& meaning) {
  nlohmann::ordered_json report = {{"baud", baud}};
  report["windows"] = nlohmann::ordered_json::array();
  for (const runtime::LoadWindow& window : load.windows()) {
    nlohmann::ordered_json entry = json_row(window.count, baud, runtime::kSecond);
    entry["from_us"] = window.start / runtime::kMicrosecond;
    report["windows"].push_back(std::move(entry));
  }
  report["all"] = json_row(load.total(), baud, load.span());
  report["identifiers"] = nlohmann::ordered_json::array();
  for (const auto& [id, count] : load.identifiers()) {
    nlohmann::ordered_json entry = json_row(count, baud, load.span());
    entry["id"] = id.id;
    entry["extended"] = id.extended;
    if (const std::string text = meaning(id); !text.empty()) entry["meaning"] = text;
    report["identifiers"].push_back(std::move(entry));
  }
  return report.dump() + "\n";
}

// The first entry says which kind of line the log is of; others are errors.
int measure(const LoadFlags& flags) {
  BusLoad load;
  ProfibusLoad profibus(flags.baud);
  size_t others = 0;
  const auto other = [&](LogPlace place, const char* expected) {
    ++others;
    fmt::print(stderr, "{}: error: no {} frame\n", place_text(flags.log, place), expected);
  };
  const size_t bad = read_log_file(flags.log, {[&](const runtime::LogEntry& entry, LogPlace place) {
                                                 if (!profibus.empty()) return other(place, "PROFIBUS");
                                                 load.add(entry.time, entry.frame);
                                               },
                                               [&](const runtime::SerialEntry&, LogPlace place) {
                                                 other(place, profibus.empty() ? "CAN" : "PROFIBUS");
                                               },
                                               [&](const runtime::ProfibusEntry& entry, LogPlace place) {
                                                 if (!load.windows().empty()) return other(place, "CAN");
                                                 profibus.add(entry.reception);
                                               },
                                               {}});
  if (!profibus.empty())
    fmt::print("{}", flags.format == "json" ? profibus.json() : profibus.text());
  else
    fmt::print("{}", flags.format == "json" ? json_report(load, flags.baud, meaning_of(flags.names))
                                            : text_report(load, flags.baud, meaning_of(flags.names)));
  return bad + others == 0 ? kGood : kBadInput;
}

}  // namespace

void add_bus_load(cli::Verb& bus) {
  auto flags = std::make_shared<LoadFlags>();
  cli::Verb& verb = bus.verb(
      "load", "load of a log: of CAN exact with stuff bits and at worst, of PROFIBUS by kind of frame");
  verb.option("LOG", flags->log,
              "log of one line, candump, pcapng, ASC, TRC, BLF or --serial-log; - is standard input")
      .required();
  verb.option("--baud", flags->baud, "of the line, for example 500000").required().between(1000U, 1'500'000U);
  verb.option("--format", flags->format, "text or json").one_of({"text", "json"});
  add_names_options(verb, flags->names);
  verb.footer("Example:\n  ipos bus load can.log --baud 500000");
  verb.runs([flags] { return measure(*flags); });
}

}  // namespace ipos::tools
