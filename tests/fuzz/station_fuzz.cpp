// One station with any valid program, any settings before power-on, and then any writes to its variables,
// parameters and inputs while it runs: it goes on, and does the same with the reference interpreter and no
// tick left out as with the fast engine and all that is left out.
#include <algorithm>

#include "runtime/plant/plant.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/fuzz/valid_code.hpp"

using namespace ipos::runtime;  // NOLINT
using namespace ipos::tests;    // NOLINT
namespace stdlib = ipos::stdlib;
namespace vm = ipos::vm;

namespace {

constexpr std::string_view kUnits[] = {"md60a", "mc07", "mdxb", "mdxb"};  // all that run programs
constexpr uint16_t kFirstVariable = 11'000;
constexpr int kPresets = 15;
// What a run costs is its two units and their time; longer ones find no more than other ones.
constexpr size_t kLongestInput = 256;
constexpr Time kLongest = 250 * kMillisecond;

// The parameters that decide what else of the unit is used.
constexpr std::string_view kDeciding[] = {
    "700", "100", "101", "077", "160", "264", "265", "276", "302", "323", "900", "901", "902", "903",
    "910", "911", "912", "913", "914", "915", "916", "920", "921", "922", "923", "930", "941", "942",
    "943", "954", "960", "961", "962", "963", "130", "131", "132", "133", "134", "135", "136", "137"};

int32_t number(Input& input) {
  const uint8_t kind = input.u8();
  switch (kind % 8) {
    case 0: return input.i32();
    case 1: return INT32_MAX - kind / 8;
    case 2: return INT32_MIN + kind / 8;
    case 3: return static_cast<int32_t>(uint32_t{1} << (kind / 8));
    case 4: return -static_cast<int32_t>(uint32_t{1} << (kind / 8 % 31));
    case 5: return input.u16();
    default: return kind / 8;
  }
}

uint16_t parameter(Input& input, const stdlib::ParameterTable& table) {
  const uint8_t choice = input.u8();
  if (choice < 128)
    if (const stdlib::Parameter* row = table.find(kDeciding[choice % std::size(kDeciding)]))
      return row->index;
  return table.rows()[input.u16() % table.rows().size()].index;
}

// Mostly the system variables.
uint16_t variable(Input& input, const stdlib::UnitType& unit) {
  const uint8_t choice = input.u8();
  const auto number = choice < 200 ? 440 + choice : input.u16() % 1024;
  return static_cast<uint16_t>(number % unit.variables);
}

class Run {
 public:
  Run(const stdlib::UnitType& unit, Input& input, const Execution& execution) {
    PlantFile file;
    file.buses.emplace_back().name = "can";
    StationConfig& config = file.stations.emplace_back();
    config.name = "u";
    config.unit = &unit;
    const uint8_t kind = input.u8();
    if (kind % 2 == 1) config.sbus = "can";
    if (kind % 16 == 3) {  // a clock for ISYNC
      ControlConfig& control = file.controls.emplace_back();
      control.name = "clock";
      control.sbus = "can";
      control.kind = ControlSettings{1, kSyncCycle, {}};
    }
    for (uint8_t n = 0; n < 6; ++n) config.inputs.push_back({n, (kind >> 2 & 1) != 0 || n == 0, {}});
    vm::Image image;
    image.unit = unit.code;
    image.code = valid_code(input, {unit.variables, unit.tasks});
    std::vector<std::optional<vm::Image>> programs{std::move(image)};
    std::vector<PlantError> errors;
    config.program = "P";
    presets(config, input, unit);
    plant_.emplace(std::move(file), std::move(programs), std::nullopt, errors, execution);
    able_ = errors.empty();
  }
  bool able() const { return able_; }

  void act(Input input) {
    while (!input.empty() && plant_->now() < kLongest) {
      const uint8_t kind = input.u8();
      ParameterStore& parameters = station().drive().parameters();
      switch (kind % 8) {
        case 0:
        case 1: {
          const auto index =
              static_cast<uint16_t>(kFirstVariable + variable(input, *station().config().unit));
          (void)parameters.execute(ParameterService::WriteVolatile, index, number(input));
          break;
        }
        case 2: {
          const uint16_t index = parameter(input, parameters.table());
          (void)parameters.execute(ParameterService::WriteVolatile, index, number(input));
          break;
        }
        case 3: {
          const size_t line = input.u8() % kInputLines;
          station().inputs().line(line).set = line < kBinaryLines ? kind / 8 % 2 : input.u16();
          break;
        }
        case 4:
          if (kind / 8 % 8 == 0) station().powered() ? station().power_off() : station().power_on();
          break;
        default: plant_->run_until(plant_->now() + (1 + kind / 8) * kMillisecond);
      }
    }
    plant_->run_until(plant_->now() + 20 * kMillisecond);
  }

  // Of all that can be seen.
  uint64_t digest() {
    uint64_t hash = 14695981039346656037U;
    const auto add = [&](uint64_t value) { hash = (hash ^ value) * 1099511628211U; };
    const Station& seen = station();
    add(seen.status_word_1());
    add(seen.outputs());
    for (const stdlib::Parameter& row : seen.drive().parameters().table().rows())
      if (row.index != 0) add(static_cast<uint32_t>(seen.drive().parameters().value(row.index)));
    if (const vm::Machine* machine = seen.machine()) {
      for (int n = 1; n <= vm::kContexts; ++n) {
        const vm::TaskContext& t = machine->context(n);
        add(t.pc);
        add(t.wait_ms);
        add(static_cast<uint64_t>(t.state));
        add(t.commands);
      }
      for (const int32_t value : machine->variables()) add(static_cast<uint32_t>(value));
    }
    for (const auto& entry : plant_->journal().entries()) {
      add(static_cast<uint64_t>(entry.time));
      for (const char c : entry.text) add(static_cast<uint8_t>(c));
    }
    return hash;
  }

 private:
  static void presets(StationConfig& config, Input& input, const stdlib::UnitType& unit) {
    const stdlib::ParameterTable& table = stdlib::parameter_table(unit);
    for (int n = input.u8() % (kPresets + 1); n > 0; --n) {
      const stdlib::Parameter* row = table.find(parameter(input, table));
      const int32_t value = number(input);
      // A refused value would be an error of the plant file, so it is brought into the range.
      if (row == nullptr || !row->writable || row->number.empty() || !row->texts.empty()) continue;
      if (row->ranges.empty()) continue;
      const stdlib::ValueRange& range = row->ranges[static_cast<size_t>(n) % row->ranges.size()];
      const int64_t steps = (range.maximum - range.minimum) / range.step;
      const int64_t set = range.minimum + static_cast<uint32_t>(value) % (steps + 1) * range.step;
      config.parameters.push_back({"P" + std::string(row->number), static_cast<int32_t>(set), {}});
    }
    if (unit.has(stdlib::Trait::Sbus2) && input.u8() % 2 == 0)
      config.parameters.push_back({"P700", 13, {}});
  }
  Station& station() { return *plant_->stations()[0]; }

  std::optional<Plant> plant_;
  bool able_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size > kLongestInput) return -1;  // not for the corpus
  Input input(data, size);
  const stdlib::UnitType& unit = *stdlib::find_unit(kUnits[input.u8() % std::size(kUnits)]);
  Input same = input;
  Execution plain;
  plain.fast = false;
  plain.pace = Pace::InTurn;
  Run reference(unit, input, plain);
  if (!reference.able()) return 0;
  Run quick(unit, same, {});
  reference.act(input);
  quick.act(same);
  require(reference.digest() == quick.digest(), "what is left out changes nothing that can be seen");
  return 0;
}
