// The plant, its faults by seed, and the checks.
#include "runtime/signals/variables.hpp"
#include "tests/runtime/bus/campaign/fault_campaign.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>

#include "compiler/compile.hpp"
#include "runtime/clock/random.hpp"
#include "runtime/plant/plant.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

constexpr Time kFaultsBegin = 50 * kMillisecond;
constexpr Time kFaultsEnd = 400 * kMillisecond;
constexpr Time kEnd = 700 * kMillisecond;
constexpr uint32_t kLongestDelay = 20;  // ms
constexpr uint16_t kWritten = 8470;     // P130 of the slaves

// Writes P130 of the units 1 to 3 in turn, each time another value; counts good and failed calls.
constexpr const char* kMaster = R"(#pragma globals 350 399
#include <const.h>
MOVLNK Ml; MLDATA Mld; SCTRCYCL Tr; SCREC R1; SCREC R2; SCREC R3;
long lCount, lFrom1, lFrom2, lFrom3, lGood, lFailed, lValue;
main()
{
  Tr.ObjectNo = 1024; Tr.CycleTime = 10; Tr.Offset = 0; Tr.Format = 4; Tr.DPointer = numof(lCount);
  _SBusCommDef(SCD_TRCYCL, Tr);
  R1.ObjectNo = 1025; R1.Format = 4; R1.DPointer = numof(lFrom1); _SBusCommDef(SCD_REC, R1);
  R2.ObjectNo = 1026; R2.Format = 4; R2.DPointer = numof(lFrom2); _SBusCommDef(SCD_REC, R2);
  R3.ObjectNo = 1027; R3.Format = 4; R3.DPointer = numof(lFrom3); _SBusCommDef(SCD_REC, R3);
  _SBusCommOn();
  Ml.BusType = 5; Ml.Format = 6; Ml.Service = 2; Ml.Index = 8470; Ml.DPointer = numof(Mld);
  while (1)
  {
    lCount = lCount + 1;
    Ml.Address = lCount % 3 + 1;
    lValue = (lValue + 10) % 1000;
    Mld.WritePar = lValue;
    _MoviLink(Ml);
    if (Ml.Result == 0) { lGood = lGood + 1; } else { lFailed = lFailed + 1; }
  }
}
)";

std::string slave_source(int number) {
  return fmt::format(R"(#include <const.h>
SCTRCYCL Tr; SCREC Rec; long lCount, lFrom0;
main()
{{
  Tr.ObjectNo = {}; Tr.CycleTime = {}; Tr.Offset = 10; Tr.Format = 4; Tr.DPointer = numof(lCount);
  _SBusCommDef(SCD_TRCYCL, Tr);
  Rec.ObjectNo = 1024; Rec.Format = 4; Rec.DPointer = numof(lFrom0); _SBusCommDef(SCD_REC, Rec);
  _SBusCommOn();
  while (1) {{ lCount = lCount + 1; }}
}}
)",
                     1024 + number, number == 1 ? 5 : 10 * number);
}

// Built once: programs are compiled and the plant file is made by hand.
struct Blueprint {
  PlantFile file;
  std::vector<std::optional<vm::Image>> programs;

  Blueprint() {
    file.buses.emplace_back();
    file.buses[0].name = "sbus";
    for (int n = 0; n < 4; ++n) {
      StationConfig station;
      station.name = fmt::format("unit{}", n);
      station.unit = stdlib::find_unit("md60a");
      station.sbus = "sbus";
      station.parameters.push_back({"P813", n, {}});
      station.place.line = static_cast<uint32_t>(n + 1);
      file.stations.push_back(station);
      programs.push_back(
          compiler::compile(station.name, station.name, n == 0 ? kMaster : slave_source(n)).image);
    }
    ControlConfig control;
    control.name = "plc";
    control.sbus = "sbus";
    control.kind = ControlSettings{
        0, kSyncCycle, {{1, false, {6, 100, 0}, 0}, {2, false, {6, 200, 0}, 7 * kMillisecond}}};
    control.place.line = 3;  // in the middle of the cable
    file.controls.push_back(control);
  }
};

Time between(Random& random, Time low, Time high) {
  return low +
         static_cast<Time>(random.below(static_cast<uint32_t>((high - low) / kMicrosecond))) * kMicrosecond;
}

std::vector<FaultConfig> random_faults(uint64_t seed) {
  Random random(seed);
  std::vector<FaultConfig> faults;
  const uint32_t count = 2 + random.below(5);
  for (uint32_t n = 0; n < count; ++n) {
    FaultConfig config;
    config.bus = "sbus";
    LineFault& fault = config.fault;
    const FaultType& type = kFaultTypes[random.below(std::size(kFaultTypes))];
    fault.kind = type.kind;
    fault.from = between(random, kFaultsBegin, kFaultsEnd - 60 * kMillisecond);
    fault.until = type.scope == FaultScope::Frame
                      ? between(random, fault.from + kMillisecond, kFaultsEnd)
                      : fault.from + between(random, kMillisecond, 50 * kMillisecond);
    const std::string station = fmt::format("unit{}", random.below(4));
    const bool alone =
        type.kind == FaultKind::Swap || type.kind == FaultKind::Cut || type.kind == FaultKind::Baud ||
        ((type.kind == FaultKind::Corrupt || type.kind == FaultKind::Drop || type.kind == FaultKind::Delay) &&
         random.below(2) == 0);
    if (alone) config.station = station;
    fault.behind = type.kind == FaultKind::Cut && random.below(2) == 0;
    if (type.kind == FaultKind::Baud) fault.baud = kBaudRates[random.below(2) == 0 ? 1 : 3];
    if (type.scope == FaultScope::Frame) {
      fault.seed = random.next();
      if (random.below(4) == 0)
        fault.frame = 1 + random.below(50);
      else
        fault.per_mille = 1 + random.below(200);
      fault.lag = between(random, 0, kLongestDelay * kMillisecond);
    }
    faults.push_back(config);
  }
  return faults;
}

class Run final : private CanObserver {
 public:
  Run(const Blueprint& blueprint, uint64_t seed, FaultTotals& totals) : seed_(seed), totals_(totals) {
    PlantFile file = blueprint.file;
    file.faults = random_faults(seed);
    std::vector<PlantError> errors;
    plant_ = std::make_unique<Plant>(std::move(file), blueprint.programs, vm::Rates{{50, 50, 50}}, errors);
    for (const auto& program : blueprint.programs)
      if (!program) errors.push_back({{}, "a program does not compile"});
    if (!errors.empty()) {
      fail(errors[0].text);
      return;
    }
    plant_->add_observer(*this);
    for (size_t n = 0; n < values_.size(); ++n) values_[n] = value_of(n);
    go();
    ++totals_.seeds;
  }

 private:
  struct Request {
    Time end;
    int32_t value;
  };

  void on_frame(const CanLine&, const FrameRecord& record) override {
    ++totals_.frames;
    const Frame& frame = record.frame;
    ++seen_[frame.id];
    if (frame.id >= 1024) last_[frame.id] = frame;
    // Write requests to the units 1 to 3: 523, 531, 539.
    for (uint32_t n = 1; n < 4; ++n)
      if (frame.id == 8 * n + 515 && frame.data[0] == 0x32 &&
          (frame.data[2] << 8 | frame.data[3]) == kWritten)
        requests_[n].push_back(
            {record.end, frame.data[4] << 24 | frame.data[5] << 16 | frame.data[6] << 8 | frame.data[7]});
  }
  void on_line_event(const CanLine&, const LineEvent& event) override {
    if (event.kind == LineEventKind::FaultStrikes) ++totals_.struck[event.fault];
    if (event.kind == LineEventKind::BusOff) ++totals_.bus_off;
  }

  int32_t variable(size_t station, const char* name) const {
    const Station& s = *plant_->stations()[station];
    return s.variable(*signals::find_variable(s, name));
  }
  int32_t value_of(size_t station) const {
    return plant_->stations()[station]->drive().parameters().value(kWritten);
  }
  void fail(const std::string& text) { totals_.failures.push_back(fmt::format("seed {}: {}", seed_, text)); }

  void go() {
    int32_t failed_before = 0;
    for (Time at = kMillisecond; at <= kFaultsEnd + kRecovery; at += kMillisecond) {
      plant_->run_until(at);
      check_parameters(at);
      if (const int32_t failed = variable(0, "lFailed"); failed != failed_before) {
        if (at > kFaultsEnd) totals_.longest_recovery = std::max(totals_.longest_recovery, at - kFaultsEnd);
        failed_before = failed;
      }
    }
    const std::map<uint32_t, uint64_t> seen = seen_;
    const int32_t good = variable(0, "lGood");
    const int32_t failed = variable(0, "lFailed");
    const SbusControl& control = plant_->all<MovilinkControl>()[0]->control();
    const auto first = control.answers(0);
    const auto second = control.answers(1);
    for (Time at = kFaultsEnd + kRecovery; at <= kEnd; at += kMillisecond) {
      plant_->run_until(at);
      check_parameters(at);
    }
    totals_.calls_good += static_cast<uint64_t>(variable(0, "lGood"));
    totals_.calls_failed += static_cast<uint64_t>(variable(0, "lFailed"));
    if (variable(0, "lFailed") != failed) fail("MOVLNK fails after the recovery time");
    if (variable(0, "lGood") < good + 20) fail("MOVLNK does not go on after the recovery time");
    check_process_data("synchronous", first, control.answers(0), 40);
    check_process_data("asynchronous", second, control.answers(1), 28);
    check_variables(seen);
    for (NodeId node = 0; node < plant_->all<CanBus>()[0]->line().node_count(); ++node)
      if (!plant_->all<CanBus>()[0]->line().is_reachable(0, node) && node != 0) fail("a station is still not on the line");
  }

  void check_process_data(const char* what, const SbusControl::Answers& before,
                          const SbusControl::Answers& after, uint64_t expected) {
    const uint64_t asked = after.asked - before.asked;
    const uint64_t answered = after.answered - before.answered;
    if (asked < expected - 1 || asked > expected + 1 || answered + 1 < asked || answered > asked + 1)
      fail(fmt::format("{} PO: {} sent, {} answered after the recovery time", what, asked, answered));
  }

  void check_variables(const std::map<uint32_t, uint64_t>& before) {
    constexpr uint64_t kSpan = static_cast<uint64_t>((kEnd - kFaultsEnd - kRecovery) / kMillisecond);
    const std::map<uint32_t, uint64_t> cycles = {{1024, 10}, {1025, 5}, {1026, 20}, {1027, 30}};
    for (const auto& [id, cycle] : cycles) {
      const auto known = before.find(id);
      const uint64_t count = seen_[id] - (known == before.end() ? 0 : known->second);
      if (count + 1 < kSpan / cycle || count > kSpan / cycle + 1)
        fail(fmt::format("object {}: {} frames after the recovery time", id, count));
    }
    const auto carried = [&](uint32_t id) {
      const Frame& frame = last_[id];
      return frame.data[0] << 24 | frame.data[1] << 16 | frame.data[2] << 8 | frame.data[3];
    };
    for (size_t n = 1; n < 4; ++n)
      if (variable(n, "lFrom0") != carried(1024))
        fail(fmt::format("unit{} has an old value of object 1024", n));
    const char* names[] = {"", "lFrom1", "lFrom2", "lFrom3"};
    for (uint32_t n = 1; n < 4; ++n)
      if (variable(0, names[n]) != carried(1024 + n))
        fail(fmt::format("unit0 has an old value of object {}", 1024 + n));
  }

  // A new value must have been on the line since the last look, or as long before as a delay can be.
  void check_parameters(Time now) {
    for (size_t n = 1; n < 4; ++n) {
      const int32_t value = value_of(n);
      if (value == values_[n]) continue;
      values_[n] = value;
      ++totals_.parameter_changes;
      bool found = false;
      for (const Request& request : requests_[n])
        found |= request.value == value && request.end <= now &&
                 request.end >= now - (kLongestDelay + 2) * kMillisecond;
      if (!found)
        fail(fmt::format("P130 of unit{} is {} at {} us without a request", n, value, now / kMicrosecond));
      const uint32_t writes = plant_->stations()[n]->drive().parameters().eeprom_writes(kWritten);
      if (writes > requests_[n].size())
        fail(fmt::format("unit{} has carried out {} writes, {} requests came", n, writes,
                         requests_[n].size()));
    }
  }

  uint64_t seed_;
  FaultTotals& totals_;
  std::unique_ptr<Plant> plant_;
  std::array<int32_t, 4> values_{};
  std::array<std::vector<Request>, 4> requests_;
  std::map<uint32_t, uint64_t> seen_;
  std::map<uint32_t, Frame> last_;
};

}  // namespace

FaultTotals run_faults(uint64_t first_seed, uint64_t count) {
  const Blueprint blueprint;
  FaultTotals totals;
  for (uint64_t seed = first_seed; seed < first_seed + count; ++seed) Run(blueprint, seed, totals);
  return totals;
}

std::string summary(const FaultTotals& totals) {
  std::string text = fmt::format(
      "faults: {} seeds, {} frames, {} MOVLNK calls good and {} failed, {} parameter changes, {} times "
      "bus-off;\n"
      "struck:",
      totals.seeds, totals.frames, totals.calls_good, totals.calls_failed, totals.parameter_changes,
      totals.bus_off);
  for (size_t n = 0; n < totals.struck.size(); ++n)
    text += fmt::format(" {} {}", kFaultTypes[n].word, totals.struck[n]);
  return text + fmt::format(";\nlast failed call {} ms after the last fault, {} ms allowed; {} failures",
                            totals.longest_recovery / kMillisecond, kRecovery / kMillisecond,
                            totals.failures.size());
}

}  // namespace ipos::tests
