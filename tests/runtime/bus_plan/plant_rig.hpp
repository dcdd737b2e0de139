// A plant for tests: a plant file as text with its programs as text, compiled and powered on; keeps all
// frames.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/signals/variables.hpp"
#include "stdlib/unit_text.hpp"
#include "tests/harness/reach.hpp"

namespace ipos::tests {

using namespace ipos::runtime;  // NOLINT: a test header, everything here is about the runtime

class PlantRig final : private CanObserver {
 public:
  // Sources by the file name that the plant gives as program; `atomic` as in the compiler's options.
  explicit PlantRig(const std::string& toml, const std::map<std::string, std::string>& sources = {},
                    std::optional<vm::Rates> rates = {}, bool atomic = false) {
    goes_through(kPlantFile);
    PlantFileResult file = read_plant_file(toml);
    for (const PlantError& error : file.errors)
      errors.push_back(std::to_string(error.place.line) + ": " + error.text);
    if (!file.errors.empty()) return;
    std::vector<std::optional<vm::Image>> programs;
    for (const StationConfig& station : file.plant.stations) {
      programs.emplace_back();
      if (station.program.empty()) continue;
      compiler::CompileOptions options;
      options.unit = station.unit;
      options.atomic = atomic;
      const compiler::Compilation compiled =
          compiler::compile(station.program, station.program, sources.at(station.program), options);
      EXPECT_TRUE(compiled.image) << compiler::render_text(compiled.diagnostics.all(), *compiled.sources,
                                                           false);
      programs.back() = compiled.image;
    }
    std::vector<PlantError> refused;
    plant = std::make_unique<Plant>(std::move(file.plant), std::move(programs), rates, refused);
    for (const PlantError& error : refused) errors.push_back(error.text);
    plant->add_observer(*this);
  }

  // A plant with errors is not there: the test fails in a way that says why.
  Plant& get() {
    if (plant && errors.empty()) return *plant;
    for (const std::string& error : errors) std::cerr << error << '\n';
    std::abort();
  }
  void run_until(Time end) { get().run_until(end); }
  Station& station(size_t n) { return *plant->stations()[n]; }
  int32_t variable(size_t n, const std::string& name) {
    const auto number = signals::find_variable(station(n), name);
    EXPECT_TRUE(number) << name;
    return number ? station(n).variable(*number) : 0;
  }

  // Times says the text, in the journal with its station.
  size_t says(const std::string& part) const {
    size_t count = 0;
    for (const JournalEntry& entry : plant->journal().entries())
      count += (entry.station + ": " + entry.text).find(part) != std::string::npos ? 1 : 0;
    return count;
  }
  // What the journal says of the buses: without why a drive is not enabled and what its setpoint is about.
  std::string journal() const {
    constexpr std::string_view kNotes[] = {
#define SETPOINT_NOTE(name, text) text,
#include "runtime/drive/setpoint_notes.def"
    };
    std::string text;
    for (const JournalEntry& entry : plant->journal().entries()) {
      const bool of_drive = entry.text.starts_with("not enabled: ") ||
                            std::any_of(std::begin(kNotes), std::end(kNotes), [&entry](std::string_view note) {
                              const auto& units = stdlib::unit_types();
                              return std::any_of(units.begin(), units.end(), [&](const stdlib::UnitType& unit) {
                                return stdlib::unit_text(unit, note) == entry.text;
                              });
                            });
      if (!of_drive) text += entry.station + ": " + entry.text + "\n";
    }
    return text;
  }

  std::vector<FrameRecord> with(uint32_t id) const {
    std::vector<FrameRecord> found;
    for (const FrameRecord& record : frames)
      if (record.frame.id == id) found.push_back(record);
    return found;
  }
  std::vector<uint32_t> ids() const {
    std::vector<uint32_t> out;
    for (const FrameRecord& record : frames) out.push_back(record.frame.id);
    return out;
  }

  std::unique_ptr<Plant> plant;
  std::vector<FrameRecord> frames;
  std::vector<std::string> errors;

 private:
  void on_frame(const CanLine&, const FrameRecord& record) override { frames.push_back(record); }
  void on_line_event(const CanLine&, const LineEvent&) override {}
};

inline std::string bus_text(uint32_t baud = 500'000, const std::string& more = "") {
  return "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = " + std::to_string(baud) + "\n" + more;
}

// `parameters` are lines such as "P813 = 1\n"; `keys` lines of the [[station]] itself.
inline std::string station_text(const std::string& name, const std::string& parameters,
                                const std::string& unit = "md60a", const std::string& program = "",
                                const std::string& keys = "") {
  return "[[station]]\nname = \"" + name + "\"\nunit = \"" + unit + "\"\nsbus = \"sbus\"\n" +
         (program.empty() ? "" : "program = \"" + program + "\"\n") + keys + "[station.parameters]\n" +
         parameters;
}

inline std::string fault_text(const std::string& kind, const std::string& more) {
  return "[[fault]]\nbus = \"sbus\"\nkind = \"" + kind + "\"\n" + more;
}

}  // namespace ipos::tests
