// A plant of stations without programs from the text of its file, and the errors that it has.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "tests/harness/reach.hpp"

namespace ipos::tests {

struct PlainPlant {
  explicit PlainPlant(const std::string& text) {
    goes_through(kPlantFile);
    runtime::PlantFileResult file = runtime::read_plant_file(text);
    for (const auto& error : file.errors) ADD_FAILURE() << text << error.place.line << ": " << error.text;
    std::vector<std::optional<vm::Image>> programs(file.plant.stations.size());
    plant =
        std::make_unique<runtime::Plant>(std::move(file.plant), std::move(programs), std::nullopt, errors);
  }
  runtime::Plant* operator->() const { return plant.get(); }
  runtime::Plant& operator*() const { return *plant; }
  runtime::Station& station(size_t n = 0) const { return *plant->stations()[n]; }
  int32_t parameter(const char* number, size_t n = 0) const { return station(n).drive().value(number); }

  // The texts of the journal that are of a station ("": of the plant) and have this in them.
  std::vector<std::string> told(const std::string& station, const std::string& text) const {
    std::vector<std::string> found;
    for (const runtime::JournalEntry& entry : plant->journal().entries())
      if (entry.station == station && entry.text.find(text) != std::string::npos) found.push_back(entry.text);
    return found;
  }

  std::vector<runtime::PlantError> errors;
  std::unique_ptr<runtime::Plant> plant;
};

}  // namespace ipos::tests
