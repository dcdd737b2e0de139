// [[machine]] of the plant file: mechanics that ipos did not write, as an FMU. What such a machine is to the plant stands here,
// and nothing of how it is made: numbers go in, a step of time passes, numbers come out. runtime/fmi_import makes them of FMUs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/plant_file/toml_text.hpp"

namespace ipos::runtime {

// Value in the base unit = value x factor + offset; the exponents are those of kg, m, s, A, K, mol, cd, rad.
struct PhysicalUnit {
  std::string name;
  std::array<int8_t, 8> exponents{};
  double factor = 1;
  double offset = 0;
};

struct MachineVariable {
  enum class Role : uint8_t { Input, Output, Parameter };
  uint32_t number = 0;  // in its model
  bool is_whole = false;  // takes whole numbers and truth values only
  std::optional<PhysicalUnit> unit{};
};

// A line that a machine says, on its output or by its log.
struct MachineWord {
  bool warns = false;
  std::string text;
};

// One machine that moves. After an error nothing more is asked of it.
class MachineRun {
 public:
  using Done = tl::expected<void, std::string>;

  MachineRun() = default;
  MachineRun(const MachineRun&) = delete;
  MachineRun& operator=(const MachineRun&) = delete;
  virtual ~MachineRun() = default;

  // At time 0.
  virtual Done start(std::span<const double> in, std::span<double> out) = 0;
  // From `at` on for `length` ns with these inputs; `out` is what it gives at the end.
  virtual Done step(int64_t at, int64_t length, std::span<const double> in, std::span<double> out) = 0;
  // What it has said since the last time.
  virtual std::vector<MachineWord> take_words() = 0;
  // Its state as bytes, and back; nothing where it cannot give it.
  virtual std::optional<std::string> save() = 0;
  virtual Done restore(const std::string& state) = 0;
};

struct MachineParameter {
  uint32_t number = 0;  // of the variable
  double value = 0;
};

class MachineModel {
 public:
  MachineModel() = default;
  MachineModel(const MachineModel&) = delete;
  MachineModel& operator=(const MachineModel&) = delete;
  virtual ~MachineModel() = default;

  // The error says what it has instead.
  virtual tl::expected<MachineVariable, std::string> find(std::string_view name, MachineVariable::Role role) const = 0;
  // The numbers of its variables, in the order in which the values come and go. `limit` is the time on the clock that one
  // answer may take, in ns.
  struct Wiring {
    std::string name;  // of the machine
    std::vector<uint32_t> inputs;
    std::vector<uint32_t> outputs;
    std::vector<MachineParameter> parameters;
    int64_t limit = 0;
  };
  virtual std::unique_ptr<MachineRun> make(Wiring wiring) const = 0;
  virtual bool gives_state() const = 0;
  // What is odd about it at this step, for the journal; empty: nothing.
  virtual std::string remark(int64_t step) const = 0;
};

// A variable of the machine and the signal that it is wired with, by its whole name.
struct MachineWire {
  std::string variable;
  std::string signal;
  FilePlace place;  // of the variable's value
};

struct MachineSetting {
  std::string variable;
  double value = 0;
  FilePlace place;
};

struct MachineConfig {
  std::string name;
  std::string fmu;  // file, relative to the plant file
  int64_t every = 1'000'000;        // ns, whole milliseconds
  int64_t limit = 10'000'000'000;   // ns on the clock that an answer may take
  std::vector<MachineWire> inputs;
  std::vector<MachineWire> outputs;
  std::vector<MachineSetting> parameters;
  std::shared_ptr<const MachineModel> model;  // null: nobody has opened the file
  FilePlace place;
  FilePlace fmu_place;
};

}  // namespace ipos::runtime
