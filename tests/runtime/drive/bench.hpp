// Where a drive stands in these tests, alone or in a plant, and what a millisecond is there. The same statements are shown
// twice: ipos_drive_tests asks the classes, so that a failure names the drive; ipos_drive_plant_tests (IPOS_DRIVE_IN_A_PLANT)
// asks the station of a plant file, with its terminals and its clock, as a user has it.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/drive/drive.hpp"
#include "tests/runtime/drive/fake_drive.hpp"

#ifdef IPOS_DRIVE_IN_A_PLANT
#include "runtime/plant/plant.hpp"
#include "tests/harness/reach.hpp"
#endif

namespace ipos::tests {

#ifdef IPOS_DRIVE_IN_A_PLANT

struct PlantOfOne {
  PlantOfOne(std::string_view name, const runtime::DriveOptions& options, const runtime::MachineData& machine) {
    goes_through(kPlantFile);
    runtime::PlantFileResult file =
        runtime::read_plant_file("[[station]]\nname = 'u'\nunit = '" + std::string(name) + "'\n");
    for (const auto& error : file.errors) ADD_FAILURE() << error.text;
    file.plant.stations.at(0).options = options;
    file.plant.stations.at(0).machine = machine;
    std::vector<runtime::PlantError> errors;
    runtime::Execution execution;
    execution.pace = runtime::Pace::InTurn;  // the tests look at the drive behind the station's back
    plant = std::make_unique<runtime::Plant>(std::move(file.plant), std::vector<std::optional<vm::Image>>(1), std::nullopt,
                                             errors, execution);
    for (const auto& error : errors) ADD_FAILURE() << error.text;
  }
  runtime::Station& station() { return *plant->stations()[0]; }
  std::unique_ptr<runtime::Plant> plant;
};

class Bench : private PlantOfOne {
 public:
  Bench(std::string_view name, const runtime::DriveOptions& options, const runtime::MachineData& machine)
      : PlantOfOne(name, options, machine),
        parameters(station().drive().parameters()),
        drive(station().drive().state()) {}

  // What a plant begins with, behind the settings of power-on: its milliseconds at 0 and at 1 ms.
  static constexpr int kTicksBefore = 2;
  void begin() { plant->run_until(runtime::kMillisecond); }

  // What a test gives the drive hangs on the terminals of the station.
  void tick() {
    for (size_t n = 0; n < runtime::kBinaryLines; ++n) station().inputs().line(n).set = drive.inputs() >> n & 1;
    runtime::AnalogInputs analog = drive.analog();
    for (size_t n = runtime::kBinaryLines; n < runtime::kInputLines; ++n)
      station().inputs().line(n).set = runtime::analog_value(analog, n);
    plant->run_until(next_);
    next_ += runtime::kMillisecond;
  }

  // The control word of a program, H484; the station has no program, and its variables can be written all the same.
  void program_word(uint32_t word) {
    constexpr uint16_t kControlWord = 11'484;
    const auto reply = parameters.execute(runtime::ParameterService::WriteVolatile, kControlWord, static_cast<int32_t>(word));
    EXPECT_TRUE(reply) << word;
    drive.set_ipos_control_word(word);
  }

  runtime::ParameterStore& parameters;
  runtime::Drive& drive;

 private:
  runtime::Time next_ = kTicksBefore * runtime::kMillisecond;
};

#else

class Bench {
 public:
  Bench(std::string_view name, const runtime::DriveOptions& options, const runtime::MachineData& machine)
      : parameters(unit(name), options), drive(parameters, machine) {}
  static constexpr int kTicksBefore = 0;
  void begin() {}

  void tick() { drive.tick(positioning); }
  void program_word(uint32_t word) { drive.set_ipos_control_word(word); }

  runtime::ParameterStore parameters;
  runtime::Drive drive;
  runtime::PositionControl positioning;  // nothing, unless the test wants it
};

#endif

}  // namespace ipos::tests
