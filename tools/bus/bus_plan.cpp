// ipos bus plan: what a plant puts on its lines and what is wrong with it, as text or JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus_plan/plan.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/bus/reaction.hpp"
#include "tools/bus/reaction_chains.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/json_text.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_objects.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

using runtime::BusPlan;
using runtime::Finding;
using runtime::LinePlan;
using runtime::PlannedTelegram;
using runtime::Rhythm;
using runtime::Time;

struct PlanFlags {
  std::string plant;
  std::string trial;
  std::string acyclic;
  std::string format = "text";
  bool reaction = false;
  CompileFlags compile;
};

constexpr const char* kRhythms[] = {"cyclic", "answer", "acyclic"};

std::string millis(Time time) {
  return fmt::format("{}.{:03}", time / runtime::kMillisecond,
                     time % runtime::kMillisecond / runtime::kMicrosecond);
}

std::string per_mille(uint64_t part, uint64_t whole) {
  const uint64_t value = part * 1000 / whole;
  return fmt::format("{}.{} %", value / 10, value % 10);
}

std::string all_words(const std::vector<uint32_t>& ids) {
  std::string text;
  for (const uint32_t id : ids) text += (text.empty() ? "" : ", ") + runtime::id_words(id);
  return text;
}

std::string line_text(const LinePlan& line) {
  std::string text = fmt::format("{}: {} baud, {} stations", line.name, line.baud, line.stations);
  text += line.length == 0 ? fmt::format(", cable up to {} m\n", line.length_limit)
                           : fmt::format(", {} m of cable, up to {} m\n", line.length, line.length_limit);
  text += fmt::format("\n{} identifiers\n", line.identifiers.size());
  for (const auto& identifier : line.identifiers)
    for (const auto& use : identifier.uses)
      text += fmt::format("  {:<11}  {:<8}  {:<12}  {}\n", runtime::id_words(identifier.id),
                          use.transmits ? "transmit" : "receive", use.station, use.what);
  if (!line.closed.empty()) text += "\nclosed to variable objects\n";
  for (const auto& closed : line.closed) {
    text += fmt::format("  {}, transmit: {}\n", closed.station, all_words(closed.transmit));
    text += fmt::format("  {}, receive:  {}\n", closed.station, all_words(closed.receive));
  }
  text +=
      fmt::format("\ntelegrams, worst-case load {} of at most 70 %\n", per_mille(line.load_bits, line.baud));
  if (!line.telegrams.empty())
    text += fmt::format("{:>6}  {:<7}  {:>11}  {:>5}  {:>13}  {:<12}  {}\n", "id", "rhythm", "period ms",
                        "bytes", "response ms", "sender", "telegram");
  for (const PlannedTelegram& telegram : line.telegrams)
    text +=
        fmt::format("{:>6}  {:<7}  {:>11}  {:>5}  {:>13}  {:<12}  {}\n", runtime::id_text(telegram.id),
                    kRhythms[static_cast<size_t>(telegram.rhythm)], millis(telegram.period), telegram.bytes,
                    telegram.response.bounded ? millis(telegram.response.worst) : "unbounded",
                    telegram.sender, telegram.what);
  return text + "\n";
}

std::string serial_text(const runtime::SerialLinePlan& line, Time trial) {
  std::string text =
      fmt::format("{}: {}, {} baud, {} stations", line.name, line.kind, line.baud, line.stations.size());
  text += line.length == 0 ? fmt::format(", cable up to {} m\n\n", line.length_limit)
                           : fmt::format(", {} m of cable, up to {} m\n\n", line.length, line.length_limit);
  for (const auto& station : line.stations)
    text += fmt::format("  {:<12}  {:<3}  address {}, group {}\n", station.name, station.socket,
                        station.address, station.group);
  text += fmt::format("\ntelegrams in the trial run of {} ms\n", millis(trial));
  if (!line.telegrams.empty())
    text += fmt::format("{:>6}  {:>10}  {:>5}  {:>7}  {:<12}  {}\n", "count", "closest ms", "bytes",
                        "wire ms", "sender", "telegram");
  for (const auto& telegram : line.telegrams)
    text += fmt::format("{:>6}  {:>10}  {:>5}  {:>7}  {:<12}  {} {}, {}\n", telegram.count,
                        telegram.closest == runtime::kNever ? "-" : millis(telegram.closest), telegram.bytes,
                        millis(telegram.wire), telegram.sender,
                        telegram.response ? "response of" : "request to", telegram.address, telegram.format);
  return text;
}

std::string profibus_text(const runtime::ProfibusLinePlan& line) {
  std::string text = fmt::format("{}: PROFIBUS, {} baud, {} stations, master{} {}", line.name, line.baud,
                                 line.stations.size(), line.masters.size() > 1 ? "s" : "",
                                 fmt::join(line.masters, ", "));
  text += line.length == 0 ? fmt::format(", cable up to {} m\n\n", line.length_limit)
                           : fmt::format(", {} m of cable, up to {} m\n\n", line.length, line.length_limit);
  for (const auto& station : line.stations)
    text += fmt::format(
        "  {:<12}  address {:>3}, ident {:04X}h, {}{}\n", station.name, station.address, station.ident,
        station.octets == 0 ? std::string("no master configures it")
                            : fmt::format("{} octets each way", station.octets),
        station.watchdog == runtime::kNever ? std::string()
                                            : fmt::format(", watchdog {} ms", millis(station.watchdog)));
  const size_t masters = line.masters.size();
  return text + fmt::format("\ncycle of {} with a GAP poll: {} bits, {} ms\n",
                            masters == 1 ? "one master" : fmt::format("{} masters, each", masters),
                            line.cycle_bits, millis(line.cycle));
}

std::string assumptions(const BusPlan& plan) {
  return fmt::format(
      "assumed: worst-case stuffing, no errors on the line, each station offers its lowest identifier first; "
      "PI\n"
      "queued within 1 ms of its PO, parameter responses within 2 ms (ours); acyclic telegrams no closer "
      "than in the\n"
      "trial run of {} ms, those seen once or never {} ms apart. Response: from the event to the end of the "
      "frame,\n"
      "of answers from that of the request.\n",
      millis(plan.trial), millis(plan.acyclic));
}

std::string finding_text(const Finding& finding) {
  const runtime::FindingType& type = finding_type(finding.kind);
  return fmt::format("{}{}: {} [{}]\n", finding.line.empty() ? "" : finding.line + ": ",
                     type.weight == runtime::FindingWeight::Error ? "error" : "hint", finding.text,
                     type.code);
}

nlohmann::ordered_json telegram_json(const PlannedTelegram& telegram) {
  nlohmann::ordered_json entry = {{"id", telegram.id},
                                  {"sender", telegram.sender},
                                  {"telegram", telegram.what},
                                  {"bytes", telegram.bytes},
                                  {"rhythm", kRhythms[static_cast<size_t>(telegram.rhythm)]},
                                  {"period_ns", telegram.period}};
  if (telegram.response.bounded)
    entry["response_ns"] = telegram.response.worst;
  else
    entry["response_ns"] = nullptr;
  entry["blocking_ns"] = telegram.response.blocking;
  entry["busy_period_ns"] = telegram.response.busy_period;
  entry["instances"] = telegram.response.instances;
  return entry;
}

nlohmann::ordered_json line_json(const LinePlan& line) {
  using nlohmann::ordered_json;
  ordered_json entry = {{"name", line.name},
                        {"baud", line.baud},
                        {"stations", line.stations},
                        {"length_m", line.length},
                        {"length_limit_m", line.length_limit},
                        {"load_bits_per_s", line.load_bits}};
  entry["identifiers"] = ordered_json::array();
  for (const auto& identifier : line.identifiers) {
    ordered_json uses = ordered_json::array();
    for (const auto& use : identifier.uses)
      uses.push_back({{"station", use.station}, {"transmits", use.transmits}, {"what", use.what}});
    entry["identifiers"].push_back({{"id", identifier.id}, {"uses", std::move(uses)}});
  }
  entry["closed"] = ordered_json::array();
  for (const auto& closed : line.closed)
    entry["closed"].push_back(
        {{"station", closed.station}, {"transmit", closed.transmit}, {"receive", closed.receive}});
  entry["telegrams"] = ordered_json::array();
  for (const PlannedTelegram& telegram : line.telegrams)
    entry["telegrams"].push_back(telegram_json(telegram));
  return entry;
}

nlohmann::ordered_json serial_json(const runtime::SerialLinePlan& line) {
  using nlohmann::ordered_json;
  ordered_json entry = {{"name", line.name},
                        {"kind", line.kind},
                        {"baud", line.baud},
                        {"length_m", line.length},
                        {"length_limit_m", line.length_limit}};
  entry["stations"] = ordered_json::array();
  for (const auto& station : line.stations)
    entry["stations"].push_back({{"name", station.name},
                                 {"socket", station.socket},
                                 {"address", station.address},
                                 {"group", station.group}});
  entry["telegrams"] = ordered_json::array();
  for (const auto& telegram : line.telegrams) {
    ordered_json row = {{"sender", telegram.sender},     {"address", telegram.address},
                        {"response", telegram.response}, {"format", telegram.format},
                        {"bytes", telegram.bytes},       {"wire_ns", telegram.wire},
                        {"count", telegram.count}};
    row["closest_ns"] = telegram.closest == runtime::kNever ? ordered_json() : ordered_json(telegram.closest);
    entry["telegrams"].push_back(std::move(row));
  }
  return entry;
}

nlohmann::ordered_json profibus_json(const runtime::ProfibusLinePlan& line) {
  using nlohmann::ordered_json;
  ordered_json entry = {{"name", line.name},
                        {"baud", line.baud},
                        {"masters", line.masters},
                        {"length_m", line.length},
                        {"length_limit_m", line.length_limit},
                        {"cycle_bits", line.cycle_bits},
                        {"cycle_ns", line.cycle}};
  entry["stations"] = ordered_json::array();
  for (const auto& station : line.stations) {
    ordered_json row = {{"name", station.name},
                        {"address", station.address},
                        {"ident", station.ident},
                        {"octets", station.octets}};
    row["watchdog_ns"] =
        station.watchdog == runtime::kNever ? ordered_json() : ordered_json(station.watchdog);
    entry["stations"].push_back(std::move(row));
  }
  return entry;
}

nlohmann::ordered_json turns_json(const ProgramTurns& turns) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ProgramTurns::OfTask& one : turns.tasks) all.push_back({{"task", one.task}, {"turns", one.turns}, {"turn_ms", one.ms}});
  return all;
}

nlohmann::ordered_json reaction_json(const Reaction& one) {
  const auto or_null = [](const std::optional<Time>& time) {
    return time ? nlohmann::ordered_json(*time) : nlohmann::ordered_json();
  };
  return {{"line", one.line},
          {"sender", one.sender},
          {"object", one.object},
          {"receiver", one.receiver},
          {"from_input_ns", or_null(one.from_input)},
          {"from_telegram_ns", or_null(one.from_telegram)},
          {"sender_turns", turns_json(one.sent)},
          {"receiver_turns", turns_json(one.received)},
          {"because", one.because}};
}

nlohmann::ordered_json chain_json(const ReactionChain& chain, const std::vector<Reaction>& reactions) {
  using nlohmann::ordered_json;
  ordered_json stations = {reactions[chain.hops.front()].sender}, objects = ordered_json::array(), lines = ordered_json::array();
  for (const size_t hop : chain.hops) {
    stations.push_back(reactions[hop].receiver);
    objects.push_back(reactions[hop].object);
    lines.push_back(reactions[hop].line);
  }
  return {{"stations", stations},
          {"objects", objects},
          {"lines", lines},
          {"from_input_ns", chain.from_input ? ordered_json(*chain.from_input) : ordered_json()},
          {"because", chain.because},
          {"round", chain.is_round}};
}

std::string json_report(const BusPlan& plan, const std::optional<std::vector<Reaction>>& reactions) {
  using nlohmann::ordered_json;
  ordered_json report = {{"trial_ns", plan.trial}, {"acyclic_ns", plan.acyclic}};
  report["lines"] = ordered_json::array();
  for (const LinePlan& line : plan.lines) report["lines"].push_back(line_json(line));
  report["serial_lines"] = ordered_json::array();
  for (const auto& line : plan.serial_lines) report["serial_lines"].push_back(serial_json(line));
  report["profibus_lines"] = ordered_json::array();
  for (const auto& line : plan.profibus_lines) report["profibus_lines"].push_back(profibus_json(line));
  report["findings"] = ordered_json::array();
  for (const Finding& finding : plan.findings) {
    const runtime::FindingType& type = finding_type(finding.kind);
    report["findings"].push_back({{"code", type.code},
                                  {"weight", type.weight == runtime::FindingWeight::Error ? "error" : "hint"},
                                  {"line", finding.line},
                                  {"text", finding.text}});
  }
  if (reactions) {
    report["reactions"] = ordered_json::array();
    for (const Reaction& one : *reactions) report["reactions"].push_back(reaction_json(one));
    const ReactionChains chains = reaction_chains(*reactions);
    report["reaction_chains"] = ordered_json::array();
    for (const ReactionChain& chain : chains.all) report["reaction_chains"].push_back(chain_json(chain, *reactions));
    report["reaction_chains_left_out"] = chains.left_out != 0;
  }
  return json_text(report) + "\n";
}

int plan_bus(const PlanFlags& flags) {
  runtime::PlanOptions options;
  if (!flags.trial.empty()) options.trial = runtime::parse_duration(flags.trial);
  if (!flags.acyclic.empty()) options.acyclic = runtime::parse_duration(flags.acyclic);
  const auto plant = make_plant(read_plant_input(flags.plant, flags.compile, "sbus"), runtime::FileUse::Look);
  const std::vector<ObjectFinding> objects = object_findings(*plant);
  BusPlan plan = make_plan(*plant, options);
  for (const ObjectFinding& one : objects)
    if (one.finding.kind != runtime::FindingKind::Formats)  // which the trial has found
      plan.findings.push_back({one.finding.kind, one.finding.line,
                               one.place.file.empty() ? one.finding.text
                                                      : fmt::format("{} ({}:{}:{})", one.finding.text, one.place.file,
                                                                    one.place.line, one.place.column)});
  std::optional<std::vector<Reaction>> reacts;
  if (flags.reaction) reacts = reactions(*plant, plan);
  if (flags.format == "json") {
    fmt::print("{}", json_report(plan, reacts));
  } else {
    for (const LinePlan& line : plan.lines) fmt::print("{}", line_text(line));
    const char* gap = "";
    for (const auto& line : plan.serial_lines)
      fmt::print("{}{}", std::exchange(gap, "\n"), serial_text(line, plan.trial));
    for (const auto& line : plan.profibus_lines)
      fmt::print("{}{}", std::exchange(gap, "\n"), profibus_text(line));
    if (reacts) fmt::print("{}{}{}", std::exchange(gap, ""), reactions_text(*reacts), chains_text(reaction_chains(*reacts), *reacts));
    if (!plan.lines.empty()) fmt::print("{}{}", gap, assumptions(plan));
    for (const Finding& finding : plan.findings) fmt::print(stderr, "{}", finding_text(finding));
  }
  return plan.has_errors() ? kFindings : kGood;
}

std::string check_distance(const std::string& text) {
  return runtime::parse_duration(text) <= 0 ? "'" + text + "' is no time above 0; write for example 10ms" : "";
}

}  // namespace

void add_bus_plan(cli::Verb& bus) {
  auto flags = std::make_shared<PlanFlags>();
  cli::Verb& verb =
      bus.verb("plan", "identifiers, load and response times of a plant, and what is wrong with it");
  verb.option("PLANT", flags->plant, "plant (.toml), or one program").required();
  verb.option("--trial", flags->trial, "virtual time the programs run first; default 100ms")
      .check(check_time, "TIME");
  verb.option("--acyclic", flags->acyclic, "assumed distance of telegrams the trial shows once; default 10ms")
      .check(check_distance, "TIME");
  verb.flag("--reaction", flags->reaction, "the worst reaction from inputs and telegrams to outputs over the line");
  verb.option("--format", flags->format, "text or json").one_of({"text", "json"});
  add_plant_options(verb, flags->compile);
  verb.footer("Example:\n  ipos bus plan examples/scom/scom.toml");
  verb.runs([flags] { return plan_bus(*flags); });
}

}  // namespace ipos::tools
