// A program in assembler text on a drive without station: machine, system commands and what they work on.
// Time passes in milliseconds as in a station, without buses.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "compiler/asm/assembler.hpp"
#include "runtime/commands/system_commands.hpp"
#include "runtime/services/mirrored_values.hpp"
#include "runtime/services/pid_block.hpp"
#include "runtime/unit/unit_interface.hpp"
#include "runtime/unit/drive_variables.hpp"
#include "stdlib/system_variables.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::tests {

class ProgramRig {
 public:
  explicit ProgramRig(const std::string& text, const char* unit_name = "mdxb")
      : unit(*stdlib::find_unit(std::string_view(unit_name))),
        server(unit),
        movilink(unit, server, server, journal, "unit1"),
        mirrored(parameters),
        pid(parameters),
        image(assembled(text)),
        commands(services(server.memory()), journal, "unit1", &image),
        machine(verified(), commands.host()) {
    server.connect_program(machine);
    machine.start();
  }
  ~ProgramRig() { server.disconnect_program(); }
  ProgramRig(const ProgramRig&) = delete;
  ProgramRig& operator=(const ProgramRig&) = delete;

  runtime::ProgramServices services(runtime::RetainedMemory& memory) {
    return {clock, milliseconds, drive, parameters, timers, memory, movilink, {}};
  }

  int32_t& h(size_t n) { return machine.variables()[n]; }
  int32_t& h(std::string_view name) { return h(stdlib::find_system_variable(name)->number); }
  void set(size_t first, std::initializer_list<int32_t> values) {
    for (const int32_t value : values) h(first++) = value;
  }
  // Before power-on.
  void preset(const char* parameter, int32_t value) {
    ASSERT_TRUE(parameters.preset(parameters.table().find(parameter)->index, value)) << parameter;
  }
  int32_t parameter(const char* number) const {
    return parameters.stored(parameters.table().find(number)->index);
  }

  void run(uint32_t n = 1000) { machine.run(1, n); }
  runtime::Timers::Expired tick(uint32_t n = 100) {
    clock.run_until(clock.now() + runtime::kMillisecond);
    drive.tick();
    mirrored.show(machine.variables());
    runtime::show_drive(drive, runtime::drive_bits(drive), machine.variables());
    const runtime::Timers::Expired expired = timers.tick(machine.variables());
    pid.tick(machine.variables());
    vm::run_tick(machine, vm::Rates{{n, n, n}});
    mirrored.take(machine.variables());
    runtime::take_program_orders(machine.variables(), drive);
    return expired;
  }

  // The last text of the journal, or empty.
  std::string told() const { return journal.entries().empty() ? "" : journal.entries().back().text; }

  const stdlib::UnitType& unit;
  runtime::EventQueue clock;
  runtime::OwnMilliseconds milliseconds;
  runtime::Journal journal;
  runtime::UnitInterface server;
  runtime::ParameterStore& parameters = server.parameters();
  runtime::Drive& drive = server.state();
  runtime::MovilinkCommand movilink;
  runtime::Timers timers;
  runtime::MirroredValues mirrored;
  runtime::PidBlock pid;
  vm::Image image;
  runtime::SystemCommands commands;
  vm::Machine machine;

 private:
  vm::Image assembled(const std::string& text) const {
    compiler::SourceMap sources;
    compiler::Diagnostics diagnostics;
    const std::string all = ".unit " + std::string(unit.name) + "\n" + text;
    const auto made = compiler::assemble(sources.add("test.ipa", "", all), diagnostics);
    EXPECT_TRUE(made) << (diagnostics.all().empty() ? "" : diagnostics.all()[0].text) << "\n" << all;
    return made.value_or(vm::Image{});
  }
  vm::VerifiedImage verified() const {
    const vm::Limits limits{unit.variables, unit.program_words, unit.tasks, unit.call_depth};
    return vm::verify(image.code, limits, {}).image.value();
  }
};

}  // namespace ipos::tests
