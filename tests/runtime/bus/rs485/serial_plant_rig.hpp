// Plants with RS-485 for tests: a recorder and a hand-driven station on each line.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "tests/harness/reach.hpp"
#include "tests/runtime/bus/rs485/serial_rig.hpp"

namespace ipos::tests {

inline std::string bus(const std::string& name, const std::string& more = "") {
  return "[[bus]]\nname = \"" + name + "\"\nkind = \"rs485\"\n" + more;
}
inline std::string station(const std::string& name, const std::string& unit, const std::string& more,
                           const std::string& parameters = "") {
  return "[[station]]\nname = \"" + name + "\"\nunit = \"" + unit + "\"\n" + more + "[station.parameters]\n" +
         parameters;
}

// A plant without programs, with a recorder and a hand-driven station on each line.
struct PlantRun {
  explicit PlantRun(const std::string& text) {
    goes_through(kPlantFile);
    PlantFileResult file = read_plant_file(text);
    EXPECT_TRUE(file.errors.empty()) << file.errors[0].text;
    std::vector<PlantError> errors;
    const size_t count = file.plant.stations.size();
    plant = std::make_unique<Plant>(std::move(file.plant), std::vector<std::optional<vm::Image>>(count),
                                    std::nullopt, errors);
    EXPECT_TRUE(errors.empty()) << errors[0].text;
    for (const auto& serial : plant->all<runtime::SerialBus>()) {
      recorders.push_back(std::make_unique<Recorder>());
      serial->line().add_observer(*recorders.back());
      hands.push_back(std::make_unique<HandNode>(serial->line(), "hand"));
    }
  }
  void run(Time time) { plant->run_until(plant->now() + time); }
  // Asks over a line; the answers heard there.
  std::vector<std::string> ask(size_t line, const std::string& text) {
    run(30 * kMillisecond);
    recorders[line]->clear();
    hands[line]->send(telegram(text));
    run(80 * kMillisecond);
    std::vector<std::string> heard = recorders[line]->all();
    if (!heard.empty()) heard.erase(heard.begin());
    return heard;
  }
  bool told(const std::string& words) const {
    for (const JournalEntry& entry : plant->journal().entries())
      if (entry.text.find(words) != std::string::npos) return true;
    return false;
  }
  Station& station(size_t n) { return *plant->stations()[n]; }
  int32_t value(size_t n, uint16_t index) {
    return station(n).drive().parameters().execute(1, index).value();
  }

  std::unique_ptr<Plant> plant;
  std::vector<std::unique_ptr<Recorder>> recorders;
  std::vector<std::unique_ptr<HandNode>> hands;
};

}  // namespace ipos::tests
