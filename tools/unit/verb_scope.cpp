// ipos scope: the scope in a unit, set, started and read over its parameter channel; the samples as CSV.
#include <fmt/format.h>

#include <functional>

#include "runtime/drive/indices.hpp"
#include "runtime/drive/scope.hpp"
#include "stdlib/parameters.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/output_forms.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/links/link_access.hpp"
#include "tools/links/link_options.hpp"
#include "tools/parameters/parameter_target.hpp"
#include "tools/parameters/running_station.hpp"

namespace ipos::tools {
namespace {

namespace index = runtime::index;
using runtime::Scope;
using runtime::Time;
using stdlib::Service;

struct ScopeFlags {
  std::string where;  // a plant, or a port
  std::string unit_at;
  LinkFlags link;
  CompileFlags compile;
  std::vector<std::string> channels = {"P000", "P004", "P005"};
  std::string every = "1ms";
  std::string trigger;
  std::string at;
  std::string limit = "60s";
  uint32_t before = 0;
  uint32_t samples = 500;
  std::string out = "-";
};

// Lets the unit go on for a while. False: it is over, by Ctrl-C or a port that is gone.
using Wait = std::function<bool(Time)>;

class ScopeRun {
 public:
  ScopeRun(ParameterAccess& access, const ScopeFlags& flags) : access_(access), flags_(flags) {
    if (stdlib::parameter_table(access.unit()).find(index::kScopeControl) == nullptr)
      throw Failure(kUsage, fmt::format("{}: unit {} has no scope", access.name(), access.unit().name));
    if (flags.channels.size() > Scope::kChannels) throw Failure(kUsage, "the scope has four channels");
    for (const std::string& name : flags.channels) {
      const Target target = find_target(access.unit(), name);
      if (target.parameter == nullptr || target.parameter->writable)
        throw Failure(kUsage, fmt::format("'{}' is no display value of the drive", name));
      channels_.push_back(target);
    }
  }

  int run(const Wait& wait) {
    order();
    const Time limit = runtime::parse_duration(flags_.limit);
    for (Time waited = 0; read(index::kScopeState) != static_cast<int32_t>(Scope::State::Done);
         waited += kLook) {
      if (waited >= limit) {
        fmt::print(stderr, "ipos: {}: the scope is not done after {}: {}\n", access_.name(), flags_.limit,
                   text_of(find_target(access_.unit(), std::to_string(index::kScopeState)),
                           read(index::kScopeState)));
        write(index::kScopeControl, 0);
        return kFindings;
      }
      if (!wait(kLook)) return kInterrupted;
    }
    replace_file(flags_.out, csv());
    return kGood;
  }

 private:
  static constexpr Time kLook = 10 * runtime::kMillisecond;

  void order() {
    for (uint16_t n = 0; n < Scope::kChannels; ++n)
      write(static_cast<uint16_t>(index::kScopeChannel + n), n < channels_.size() ? channels_[n].index : 0);
    write(index::kScopeTime,
          static_cast<int32_t>(runtime::parse_duration(flags_.every) / runtime::kMillisecond));
    write(index::kScopeSamples, static_cast<int32_t>(flags_.samples));
    write(index::kScopeBefore, static_cast<int32_t>(flags_.before));
    order_trigger();
    write(index::kScopeControl, 1);
  }

  // "P000>500 rpm": the value stands after the sign, in words of the first channel.
  void order_trigger() {
    auto edge = Scope::Edge::None;
    if (!flags_.trigger.empty()) {
      const size_t sign = flags_.trigger.find_first_of("<>");
      if (sign == std::string::npos || flags_.trigger.substr(0, sign) != flags_.channels[0])
        throw Failure(kUsage, fmt::format("--trigger: write {}>VALUE or {}<VALUE, of the first channel",
                                          flags_.channels[0], flags_.channels[0]));
      const auto level =
          stdlib::parse_parameter_text(*channels_[0].parameter, flags_.trigger.substr(sign + 1));
      if (!level) throw Failure(kUsage, fmt::format("--trigger {}: {}", flags_.trigger, level.error()));
      write(index::kScopeLevel, *level);
      edge = flags_.trigger[sign] == '>' ? Scope::Edge::Rising : Scope::Edge::Falling;
    }
    write(index::kScopeTrigger, static_cast<int32_t>(edge));
  }

  // The time of the first sample after the trigger is 0.
  std::string csv() {
    std::string text = "time_ms";
    for (const Target& channel : channels_) text += fmt::format(",{}", name_of(table(), channel));
    text += "\n";
    const int32_t recorded = read(index::kScopeRecorded);
    const int64_t step = runtime::parse_duration(flags_.every) / runtime::kMillisecond;
    const int64_t before = flags_.trigger.empty() ? 0 : flags_.before;
    for (int32_t n = 0; n < recorded; ++n) {
      text += fmt::format("{}", (n - before) * step);
      for (size_t channel = 0; channel < channels_.size(); ++channel) {
        write(index::kScopePosition, static_cast<int32_t>(channel * Scope::kMostSamples) + n);
        const std::string value = text_of(channels_[channel], read(index::kScopeValue));
        text += "," + value.substr(0, value.find(' '));
      }
      text += "\n";
    }
    return text;
  }

  const stdlib::ParameterTable& table() const { return stdlib::parameter_table(access_.unit()); }
  int32_t read(uint16_t parameter) { return good(parameter, access_.execute(Service::Read, parameter)); }
  // Nothing of the scope is stored: it costs no EEPROM. SDO knows the plain write only.
  void write(uint16_t parameter, int32_t value) {
    good(parameter,
         access_.execute(flags_.link.canopen ? Service::Write : Service::WriteVolatile, parameter, value));
  }
  int32_t good(uint16_t parameter, const AccessReply& reply) const {
    if (reply) return *reply;
    throw Failure(
        reply.error().code ? kFindings : kIoError,
        fmt::format("{}: {}: {}", access_.name(), stdlib::index_name(table(), parameter),
                    reply.error().code ? std::string(stdlib::return_code_meaning(*reply.error().code))
                                       : reply.error().trouble));
  }

  ParameterAccess& access_;
  const ScopeFlags& flags_;
  std::vector<Target> channels_;
};

int scope_of_plant(const ScopeFlags& flags) {
  output_ending("scope -o", flags.out);
  catch_interrupts();
  const auto plant = make_plant(read_plant_input(flags.where, flags.compile), runtime::FileUse::Look);
  RunningStation access(find_station(*plant, flags.where, flags.unit_at), flags.where);
  ScopeRun run(access, flags);
  if (!flags.at.empty()) plant->run_until(runtime::parse_duration(flags.at));
  return run.run([&](Time time) {
    plant->run_until(plant->now() + time);
    return !interrupted();
  });
}

int scope_at_port(ScopeFlags& flags) {
  output_ending("scope -o", flags.out);
  flags.link.port = flags.where;
  auto link = BusLink::open(flags.link);
  BusLink& line = *link;
  const auto address = whole_number<uint8_t>(flags.unit_at);
  if (!address || !line.has_address(*address))
    throw Failure(kUsage, fmt::format("'{}' is no address of a unit at {}", flags.unit_at, flags.where));
  const auto access = open_unit(std::move(link), *address, flags.compile.unit);
  return ScopeRun(*access, flags).run([&](Time time) { return line.serve(time); });
}

std::string check_milliseconds(const std::string& text) {
  const Time time = runtime::parse_duration(text);
  return time < runtime::kMillisecond || time > 10 * runtime::kSecond || time % runtime::kMillisecond != 0
             ? "'" + text + "' is no time of whole milliseconds up to 10s"
             : "";
}

}  // namespace

void add_scope(cli::Verb& app) {
  auto flags = std::make_shared<ScopeFlags>();
  cli::Verb& verb = app.verb("scope", "records values with the scope in a unit and writes them as CSV");
  verb.option("PLANT|PORT", flags->where, "plant (.toml), which runs for it, or port of a real bus")
      .required();
  verb.option("STATION|ADDRESS", flags->unit_at, "which unit; of a plant with one station not needed");
  verb.option("--channels", flags->channels, "up to four display values; default P000,P004,P005")
      .separated_by(',')
      .one_each();
  verb.option("--every", flags->every, "time from sample to sample, default 1ms")
      .check(check_milliseconds, "TIME");
  verb.option("--trigger", flags->trigger, "edge of the first channel, \"P000>500 rpm\"; default: at once");
  verb.option("--before", flags->before, "samples before the trigger").between(0, Scope::kMostSamples - 1);
  verb.option("--samples", flags->samples, "samples of each channel, default 500")
      .between(2, Scope::kMostSamples);
  verb.option("--at", flags->at, "of a plant: start the scope at this time").check(check_time, "TIME");
  verb.option("--limit", flags->limit, "give up after this time, default 60s").check(check_time, "TIME");
  verb.option("-o", flags->out, "file to write; - is standard output");
  add_link_options(verb, flags->link, false);
  add_plant_options(verb, flags->compile);
  verb.footer(
      "Example:\n  ipos scope plant.toml saw --channels P000,P005 --trigger \"P000>500 rpm\" --before 100");
  verb.runs([flags] { return is_plant(flags->where) ? scope_of_plant(*flags) : scope_at_port(*flags); });
}

}  // namespace ipos::tools
