// A plant from the text of its file and of its programs, compiled for the stations' units.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/signals/variables.hpp"
#include "tests/harness/reach.hpp"

namespace ipos::tests {

inline std::optional<vm::Image> made(const runtime::StationConfig& station, const std::string& source) {
  compiler::CompileOptions options;
  options.unit = station.unit;
  const auto made = compiler::compile(station.program, "", source, options);
  EXPECT_TRUE(made.image) << compiler::render_text(made.diagnostics.all(), *made.sources, false);
  return made.image;
}
inline std::optional<vm::Image> made(const runtime::StationConfig& /*station*/, const vm::Image& image) {
  return image;
}

// `Program` is a source or an image.
template <class Program = std::string>
std::unique_ptr<runtime::Plant> make_plant(
    const std::string& text, const std::map<std::string, std::type_identity_t<Program>>& files = {},
    std::optional<vm::Rates> rates = std::nullopt, const runtime::Execution& execution = {}) {
  goes_through(kPlantFile);
  runtime::PlantFileResult file = runtime::read_plant_file(text);
  for (const auto& error : file.errors) ADD_FAILURE() << error.place.line << ": " << error.text;
  if (!file.errors.empty()) return nullptr;
  std::vector<std::optional<vm::Image>> programs;
  for (const runtime::StationConfig& station : file.plant.stations) {
    if (station.program.empty()) {
      programs.emplace_back();
      continue;
    }
    programs.push_back(made(station, files.at(station.program)));
    if (!programs.back()) return nullptr;
  }
  std::vector<runtime::PlantError> errors;
  auto plant =
      std::make_unique<runtime::Plant>(std::move(file.plant), std::move(programs), rates, errors, execution);
  for (const auto& error : errors) ADD_FAILURE() << error.place.line << ": " << error.text;
  return errors.empty() ? std::move(plant) : nullptr;
}

// One station "u" with a program P.IPC; `more` follows its first keys.
inline std::unique_ptr<runtime::Plant> make_station(const std::string& source, const std::string& more = "",
                                                    const std::string& unit = "mdxb") {
  return make_plant("[[station]]\nname = \"u\"\nunit = \"" + unit + "\"\nprogram = \"P.IPC\"\n" + more,
                    {{"P.IPC", source}});
}

inline int32_t value(const runtime::Plant& plant, const std::string& name, const std::string& station = "u") {
  for (const auto& candidate : const_cast<runtime::Plant&>(plant).stations())
    if (candidate->config().name == station) {
      const auto number = signals::find_variable(*candidate, name);
      EXPECT_TRUE(number) << name;
      return number ? candidate->variable(*number) : 0;
    }
  ADD_FAILURE() << "no station " << station;
  return 0;
}

// True when the journal has an entry with this text in it.
inline bool told(const runtime::Plant& plant, const std::string& text) {
  for (const auto& entry : plant.journal().entries())
    if (entry.text.find(text) != std::string::npos) return true;
  return false;
}

// Ticks are left out: the program waits, has ended, or goes round in a loop that leads nowhere.
inline bool is_asleep(const runtime::Station& station) {
  return station.behind() && station.mode() == runtime::ManyTicks::Mode::Idle;
}
// The tasks run for many ticks, and drive and positioning follow.
inline bool runs_ahead(const runtime::Station& station) {
  return station.behind() && station.mode() == runtime::ManyTicks::Mode::Ahead;
}
// Drive and positioning decide nothing.
inline bool is_steady(const runtime::Station& station) {
  return station.mode() != runtime::ManyTicks::Mode::InFull;
}

// Every millisecond of every station in its turn.
inline runtime::Execution in_turn() {
  runtime::Execution execution;
  execution.pace = runtime::Pace::InTurn;
  return execution;
}

inline constexpr runtime::Time ms(int64_t n) { return n * runtime::kMillisecond; }

}  // namespace ipos::tests
