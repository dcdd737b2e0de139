// A plant with a DP master from the text of its file, run from outside: inputs as the master has them, speeds, parameters,
// the journal.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/plant/plant.hpp"
#include "runtime/signals/find.hpp"
#include "tests/harness/proves.hpp"
#include "tests/harness/reach.hpp"
#include "tests/runtime/bus/profibus/octets.hpp"

namespace ipos::tests {

// --- parts of a plant file

inline std::string dp_line(uint32_t baud = 500'000) {
  return "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = " + std::to_string(baud) + "\n";
}
// Controlled by the bus, and enabled at its terminal 41.
inline std::string mc31_station(const std::string& parameters = "", const std::string& keys = "",
                                const std::string& name = "inv", int address = 8, const std::string& option = "ffp31") {
  return "[[station]]\nname = \"" + name + "\"\nunit = \"mc31\"\noption = \"" + option +
         "\"\nprofibus = \"dp\"\nprofibus_address = " + std::to_string(address) + "\n" + keys +
         "[station.parameters]\nP841 = 1\nP600 = 0\nP601 = 0\n" + parameters + "[station.inputs]\nDI00 = 1\n";
}
inline std::string dp_master(const std::string& slave, const std::string& more = "", const std::string& name = "plc",
                             int address = 1) {
  return "[[control]]\nname = \"" + name + "\"\nprofibus = \"dp\"\naddress = " + std::to_string(address) +
         "\n[[control.slave]]\naddress = 8\ncfg = \"F2\"\n" + slave + more;
}

struct DpPlant {
  explicit DpPlant(const std::string& text, runtime::Pace pace = runtime::Execution{}.pace) {
    goes_through(kPlantFile);
    runtime::PlantFileResult file = runtime::read_plant_file(text);
    for (const auto& error : file.errors) ADD_FAILURE() << error.place.line << ": " << error.text;
    std::vector<runtime::PlantError> errors;
    std::vector<std::optional<vm::Image>> programs(file.plant.stations.size());
    runtime::Execution execution;
    execution.pace = pace;
    plant = std::make_unique<runtime::Plant>(std::move(file.plant), std::move(programs), std::nullopt, errors,
                                             execution);
    for (const auto& error : errors) ADD_FAILURE() << error.place.line << ": " << error.text;
  }
  void run(runtime::Time end) { plant->run_until(end); }
  void run_on(runtime::Time more) { plant->run_until(plant->now() + more); }
  runtime::Station& station(size_t n = 0) { return *plant->stations()[n]; }
  int32_t speed(size_t n = 0) { return station(n).drive().state().speed(); }  // 1/1000 rpm
  int32_t value(const char* number, size_t n = 0) { return station(n).drive().value(number); }
  int fault(size_t n = 0) { return station(n).fault(); }
  profibus::Master& master() {
    for (runtime::ProfibusControl* control : plant->all<runtime::ProfibusControl>()) return control->master();
    throw std::logic_error("no DP master");
  }
  runtime::Gateway& gateway() {
    for (runtime::Gateway* control : plant->all<runtime::Gateway>()) return *control;
    throw std::logic_error("no gateway");
  }
  uint16_t input(size_t word, size_t from = 0) {  // as the master has it
    const profibus::Octets& octets = master().slave(0).inputs();
    return static_cast<uint16_t>(octets[from + 2 * word] << 8 | octets[from + 2 * word + 1]);
  }
  std::string channel() {
    const profibus::Octets& octets = master().slave(0).inputs();
    return text_of(profibus::Octets(octets.begin(), octets.begin() + 8));
  }
  // A service of the parameter channel, until its answer stands there with the handshake bit of the request.
  std::string service(const std::string& request, const std::string& words) {
    master().slave(0).set_outputs(hex(request + " " + words));
    const auto handshake = static_cast<uint8_t>(hex(request)[0] & 0x40);
    for (int n = 0; n < 300; ++n) {
      run_on(runtime::kMillisecond);
      if (n > 5 && (master().slave(0).inputs()[0] & 0x40) == handshake) break;
    }
    return channel();
  }
  // A signal as `ipos run --watch` shows it.
  std::string shown(const std::string& name) {
    const auto found = signals::find_signals(*plant, name);
    return found && found->size() == 1 ? found->front().words(found->front().read()) : "no signal " + name;
  }
  bool told(std::string_view text) {
    const auto entries = plant->journal().entries();
    return std::any_of(entries.begin(), entries.end(),
                       [&](const auto& entry) { return entry.text.find(text) != std::string::npos; });
  }
  std::unique_ptr<runtime::Plant> plant;
};

// The errors of a plant file that is refused, "line: text" each.
inline std::string errors_of(const std::string& text) {
  goes_through(kPlantFile);
  std::string found;
  for (const auto& error : runtime::read_plant_file(text).errors)
    found += std::to_string(error.place.line) + ": " + error.text + "\n";
  return found;
}

}  // namespace ipos::tests
