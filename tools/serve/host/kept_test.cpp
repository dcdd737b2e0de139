// The text of the test. Tables are in the order of time.
#include "tools/serve/host/kept_test.hpp"

#include <fmt/format.h>

#include <set>

#include "runtime/plant_file/outer_port.hpp"
#include "runtime/signals/find.hpp"
#include "tools/serve/host/step_text.hpp"

namespace ipos::tools::serve {
namespace {

using debug::Change;
using runtime::Plant;
using runtime::Time;

std::string at_row(Time time) { return fmt::format("at = \"{}ms\"\n", time / runtime::kMillisecond); }

// Why no test can do the run of this plant again.
void refuse(PlantHost& host) {
  for (const runtime::BusConfig& bus : host.plant().file().buses)
    if (runtime::has_outer_port(bus))
      throw Mistake(fmt::format("{} is joined to {}: a test has no world outside, and cannot do this run again", bus.name,
                                bus.port));
  const debug::Position& now = host.debugger().position();
  if (now.time == 0 && now.phase == debug::Phase::Between)
    throw Mistake("nothing has run yet; run or step the plant first");
  if (now.phase != debug::Phase::Between)
    throw Mistake("the plant stands within a millisecond; step once, then the test can look at its end");
}

// A single program is a plant of one station.
std::string plant_rows(const PlantHost& host) {
  const runtime::PlantFile& file = host.plant().file();
  if (host.title().ends_with(".toml")) return toml_row("plant", host.title());
  const runtime::StationConfig& station = file.stations.front();
  return fmt::format("\n[[station]]\n{}{}{}", toml_row("name", station.name), toml_row("unit", station.unit->name),
                     toml_row("program", station.program));
}

class Keeper {
 public:
  explicit Keeper(PlantHost& host) : plant_(host.plant()), now_(host.debugger().position().time) {}

  void keep_steps(const debug::Debugger& debugger) {
    for (const Change& change : debugger.changes()) {
      if (change.at > debugger.position()) continue;
      try {
        out_.text += fmt::format("\n[[step]]\n{}{}", at_row(change.at.time), step_text(plant_, change));
        if (change.at.phase != debug::Phase::Between)
          out_.left_out.push_back(fmt::format(
              "what was done at {} ms, while a program stood within that millisecond, is done at its end in the test",
              change.at.time / runtime::kMillisecond));
      } catch (const Mistake& mistake) {
        out_.left_out.push_back(
            fmt::format("what was done at {} ms: {}", change.at.time / runtime::kMillisecond, mistake.what()));
      }
    }
  }

  void keep_value(const std::string& name) {
    const auto found = signals::find_signals(plant_, name);
    if (!found) return out_.left_out.push_back(found.error());
    for (const signals::Signal& signal : *found) {
      if (!told_.insert(signal.name).second) continue;
      std::string why;
      const runtime::Signal named = signal_of(signal.station, runtime::SignalKind::Any, std::string(signal.own_name()));
      const auto again = is_line(signal.station) ? std::nullopt : signals::find_signal(plant_, named, why);
      if (again)
        expect(signal.station, "signal", named.name, signals::value_for(named, *again));
      else
        out_.left_out.push_back(fmt::format("{}: a test expects values of stations and gateways only", signal.name));
    }
  }

  void keep_outputs(const std::vector<uint32_t>& changed) {
    for (size_t n = 0; n < changed.size(); ++n) {
      const runtime::Station& station = *plant_.stations()[n];
      for (const runtime::BinaryTerminal& output : runtime::binary_outputs())
        if ((changed[n] >> output.bit & 1U) != 0 && told_.insert(fmt::format("{}.{}", station.config().name, output.name)).second)
          expect(station.config().name, "output", output.name, station.outputs() >> output.bit & 1);
    }
  }

  // A fault that the test does not name would fail it. Where nothing else is looked at it is what is expected.
  void keep_faults() {
    std::set<std::string> faulted;
    for (const runtime::JournalEntry& entry : plant_.journal().entries())
      if (entry.weight == runtime::Weight::Fault) faulted.insert(entry.station);
    const bool all = expectations_ == 0;
    for (const auto& station : plant_.stations())
      if (all || faulted.contains(station->config().name))
        expect(station->config().name, "state", "fault", station->fault());
  }

  KeptTest take() { return std::move(out_); }
  void add(const std::string& text) { out_.text += text; }

 private:
  static runtime::Signal signal_of(const std::string& station, runtime::SignalKind kind, std::string name) {
    runtime::Signal named;
    named.station = station;
    named.kind = kind;
    named.name = std::move(name);
    return named;
  }
  bool is_line(const std::string& name) const {
    for (const auto& station : plant_.stations())
      if (station->config().name == name) return false;
    for (const runtime::Gateway* gateway : plant_.all<runtime::Gateway>())
      if (gateway->name() == name) return false;
    return true;
  }

  void expect(std::string_view station, std::string_view kind, std::string_view name, int64_t value) {
    ++expectations_;
    out_.text += fmt::format("\n[[expect]]\n{}{}{}equals = {}\n", at_row(now_), toml_row("station", station),
                             toml_row(kind, name), value);
  }

  const Plant& plant_;
  Time now_;
  KeptTest out_;
  std::set<std::string> told_;
  size_t expectations_ = 0;
};

}  // namespace

KeptTest keep_as_test(PlantHost& host, const std::vector<std::string>& pinned, const std::vector<uint32_t>& changed) {
  refuse(host);
  Keeper keeper(host);
  keeper.add(fmt::format("# Kept from the page at {:.3f} s: what was done there, and what was looked at.\nby_hand = true\n",
                         static_cast<double>(host.us()) / 1e6));
  keeper.add(plant_rows(host));
  keeper.keep_steps(host.debugger());
  for (const std::string& name : pinned) keeper.keep_value(name);
  keeper.keep_outputs(changed);
  keeper.keep_faults();
  KeptTest kept = keeper.take();
  for (const auto& station : host.plant().stations())
    if (!station->config().nvram.empty())
      kept.left_out.push_back(
          fmt::format("the memory of {} ({}): a test begins with an empty one", station->config().name, station->config().nvram));
  return kept;
}

}  // namespace ipos::tools::serve
