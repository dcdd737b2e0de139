// A drive on a test bench: parameters by P-number, terminals by name, a master that repeats its process data,
// and a light machine whose shaft follows the ramp, so that times have a closed form.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>

#include "runtime/drive/drive.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/drive/bench.hpp"

namespace ipos::tests {

using runtime::Block;
using runtime::Drive;
using runtime::DriveOptions;
using runtime::FaultResponse;
using runtime::MachineData;
using runtime::ParameterService;
using runtime::PoSource;
using runtime::SetpointNote;
using runtime::UnitCondition;
using Words = Drive::Words;

inline MachineData light_machine() {
  MachineData machine;
  machine.inertia = 0;
  machine.friction = 0;
  return machine;
}

class DriveRig : public Bench {
 public:
  explicit DriveRig(std::string_view name, DriveOptions options = {},
                    const MachineData& machine = light_machine())
      : Bench(name, options, machine) {
    // No time but that of the ramps, no least speed and no monitoring, unless the test wants them.
    for (const char* number : {"P323", "P731", "P732", "P736", "P301", "P815"})
      if (parameters.table().find(number) != nullptr) set(number, 0);
    begin();
  }

  // Before power-on, or with the access of the parameter channel left out.
  void set(std::string_view number, int32_t value) {
    EXPECT_TRUE(parameters.preset(index(number), value)) << number << " = " << value;
  }
  // Over the parameter channel; the additional code, 0 when it was accepted.
  int write(std::string_view number, int32_t value) {
    const auto reply = parameters.execute(ParameterService::Write, index(number), value);
    return reply ? 0 : reply.error().additional;
  }
  int32_t value(std::string_view number) const { return parameters.value(index(number)); }
  uint16_t index(std::string_view number) const {
    const stdlib::Parameter* row = parameters.table().find(number);
    EXPECT_NE(row, nullptr) << number;
    return row == nullptr ? uint16_t{0} : row->index;
  }

  // "DI03" or "DI12".
  void input(std::string_view name, bool level) {
    const auto bit = static_cast<unsigned>((name[2] - '0') * 8 + name[3] - '0');
    const unsigned mask = 1U << bit;
    drive.set_inputs(static_cast<uint16_t>(level ? drive.inputs() | mask : drive.inputs() & ~mask));
  }
  bool output(std::string_view name) const {  // "DB00", "DO01", "DO12"
    const auto bit = static_cast<unsigned>((name[2] - '0') * 8 + name[3] - '0');
    return (drive.outputs() >> bit & 1) != 0;
  }
  // Factory terminals: no inhibit, CW, enable. DI00 counts on MOVIDRIVE only.
  void enable_terminals() {
    for (const char* name : {"DI00", "DI01", "DI03"}) input(name, true);
  }
  void ai1(int32_t millivolt) {
    auto analog = drive.analog();
    analog.ai1 = {millivolt, 0};
    drive.set_analog(analog);
  }
  void ai1_current(int32_t microampere) {
    auto analog = drive.analog();
    analog.ai1 = {0, microampere};
    drive.set_analog(analog);
  }
  void potentiometer(int32_t position) {
    auto analog = drive.analog();
    analog.potentiometer = position;
    drive.set_analog(analog);
  }

  // P100 and P101 at SBus and the terminals enabled: the master decides alone.
  void bus_control() {
    set("P100", 10);
    set("P101", 3);
    enable_terminals();
  }
  // From now on the master sends these words every 10 ms, now for the first time.
  void po(const Words& words, PoSource source = PoSource::Sbus) {
    words_ = words;
    source_ = source;
    talking_ = true;
    drive.take_po(source_, words_);
  }
  void silence() { talking_ = false; }

  void run_ms(int ms) {
    for (int i = 0; i < ms; ++i) {
      if (talking_ && ++since_po_ >= 10) {
        since_po_ = 0;
        drive.take_po(source_, words_);
      }
      tick();
    }
  }
  // How long it takes; limit + 1 when it does not happen.
  int ms_until(const std::function<bool()>& happens, int limit = 100'000) {
    int ms = 0;
    for (; ms <= limit && !happens(); ++ms) run_ms(1);
    return ms;
  }
  int ms_until_standing() {
    return ms_until([this] { return drive.axis().setpoint == 0 && drive.axis().standing; });
  }
  // Runs until the ramp is over.
  void settle() {
    run_ms(1);
    ms_until([this] { return !drive.axis().ramping; });
  }

  double rpm() const { return drive.axis().speed / 1000.0; }
  bool stage() const { return drive.axis().output_stage; }
  bool brake_released() const { return drive.axis().brake_released; }
  uint16_t status() const { return drive.status_word_1(); }
  int state() const { return drive.status_word_1() >> 8; }
  double setpoint_rpm() {
    run_ms(1);
    return drive.setpoint().speed / 1000.0;
  }
  double requested_rpm() {
    run_ms(1);
    return drive.setpoint().requested / 1000.0;
  }

 private:
  Words words_{};
  PoSource source_ = PoSource::Sbus;
  bool talking_ = false;
  int since_po_ = 0;
};

constexpr int kRampTolerance = 2;  // ms, of a measured ramp time

// Time of a linear ramp: its parameter is the time for a change by 50 Hz on MOVITRAC 07 (chapter 6.1), which
// are 1500 rpm of the four-pole motor, and by 3000 rpm on MOVIDRIVE (docs/inside/motion.md).
constexpr int m07_ramp_ms(int rpm, int parameter_ms) { return rpm * parameter_ms / 1500; }
constexpr int mdx_ramp_ms(int rpm, int parameter_ms) { return rpm * parameter_ms / 3000; }

}  // namespace ipos::tests
