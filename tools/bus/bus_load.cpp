// ipos bus load: load of a log in windows of one second and by identifier.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "compiler/diag/places.hpp"

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/log/bus_load.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/bus/log_input.hpp"
#include "tools/bus/profibus_load.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {
namespace {

using runtime::BusLoad;
using runtime::LoadCount;
using runtime::Time;

struct LoadFlags {
  LogFlags log;
  uint32_t baud = 0;
  std::string format = "text";
  NamesFlags names;
};

// What an identifier is for, where a plant or --canopen tells.
using Meaning = std::function<std::string(const runtime::LoggedIdentifier&)>;

Meaning meaning_of(const NamesFlags& flags) {
  return [names = bus_names_of(flags).can](const runtime::LoggedIdentifier& id) {
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

// With its meaning after a row.
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

nlohmann::ordered_json json_report(const BusLoad& load, uint32_t baud, const Meaning& meaning) {
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
  return report;
}

struct TimedFrame {
  Time time;
  runtime::Frame frame;
};

// Logs of several channels, and those of a clock that was set, are not always in the order of time. False: this one was not.
bool put_in_order(std::vector<TimedFrame>& frames) {
  const auto earlier = [](const TimedFrame& a, const TimedFrame& b) { return a.time < b.time; };
  const bool sorted = std::is_sorted(frames.begin(), frames.end(), earlier);
  if (!sorted) std::stable_sort(frames.begin(), frames.end(), earlier);
  return sorted;
}

// The reports of the buses of a log. A log of one bus is one report.
class Reports {
 public:
  explicit Reports(const LoadFlags& flags) : flags_(flags) {}

  void add(const std::string& bus, const std::string& text, nlohmann::ordered_json json) {
    texts_ += fmt::format("{}bus {}\n{}", texts_.empty() ? "" : "\n", compiler::printable(bus), text);
    nlohmann::ordered_json named = {{"bus", bus}};
    named.update(json);
    all_.push_back(std::move(named));
    last_text_ = text;
    last_ = std::move(json);
    names_.insert(bus);
  }
  void print(LogFindings& findings) const {
    const bool several = names_.size() > 1;
    if (flags_.format == "json")  // in ASCII: names come from strangers, and the output may be a terminal
      fmt::print("{}\n", (several ? nlohmann::ordered_json{{"buses", all_}} : last_)
                             .dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
    else
      fmt::print("{}", several ? texts_ : last_text_);
    if (several)
      findings.note(
          fmt::format("{} buses, each for itself: {}; --channel chooses", names_.size(), bus_list(names_)));
  }

 private:
  const LoadFlags& flags_;
  std::string texts_, last_text_;
  nlohmann::ordered_json all_ = nlohmann::ordered_json::array(), last_;
  std::set<std::string> names_;
};

// The first entry says which kind of bus the log is of; telegrams of others are left out.
int measure(const LoadFlags& flags) {
  std::map<std::string, std::vector<TimedFrame>> can;
  std::map<std::string, ProfibusLoad> profibus;
  LogFindings findings(flags.log.path);
  const auto other = [&] { findings.leave_out(LeftOut::OtherBus); };
  read_log_file(flags.log, findings,
                {[&](const runtime::LogEntry& entry, LogPlace) {
                   if (!profibus.empty()) return other();
                   can[entry.bus].push_back({entry.time, entry.frame});
                 },
                 [&](const runtime::SerialEntry&, LogPlace) { other(); },
                 [&](const runtime::ProfibusEntry& entry, LogPlace) {
                   if (!can.empty()) return other();
                   profibus.try_emplace(entry.line, flags.baud).first->second.add(entry.reception);
                 },
                 {}});
  Reports reports(flags);
  for (const auto& [line, load] : profibus) reports.add(line, load.text(), load.json());
  const Meaning meaning = can.empty() ? Meaning() : meaning_of(flags.names);
  bool in_order = true;
  for (auto& [bus, frames] : can) {
    in_order = put_in_order(frames) && in_order;
    BusLoad load;
    for (const TimedFrame& timed : frames) load.add(timed.time, timed.frame);
    reports.add(bus, text_report(load, flags.baud, meaning), json_report(load, flags.baud, meaning));
  }
  if (can.empty() && profibus.empty()) {
    findings.finish();
    throw Failure(kBadInput, fmt::format("{}: no frame of CAN or PROFIBUS is in it",
                                         compiler::printable(flags.log.path)));
  }
  reports.print(findings);
  if (!in_order) findings.note("its times go back; the load is that of the frames in the order of time");
  return findings.finish() ? kGood : kBadInput;
}

}  // namespace

void add_bus_load(cli::Verb& bus) {
  auto flags = std::make_shared<LoadFlags>();
  cli::Verb& verb = bus.verb(
      "load", "load of a log: of CAN exact with stuff bits and at worst, of PROFIBUS by kind of frame");
  add_log_options(verb, flags->log,
                  "log, candump, pcap, pcapng, ASC, TRC, BLF or --serial-log; - is standard input");
  verb.option("--baud", flags->baud, "of the line, for example 500000").required().between(1000U, 1'500'000U);
  verb.option("--format", flags->format, "text or json").one_of({"text", "json"});
  add_names_options(verb, flags->names);
  verb.footer("Example:\n  ipos bus load can.log --baud 500000");
  verb.runs([flags] { return measure(*flags); });
}

}  // namespace ipos::tools
