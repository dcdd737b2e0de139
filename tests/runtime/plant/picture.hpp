// All that a plant shows, as text: to compare two runs of it.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>

#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/log/serial_log.hpp"
#include "runtime/plant/plant.hpp"

namespace ipos::tests {

// At this moment.
inline std::string picture(const runtime::Plant& plant) {
  std::string out;
  for (const auto& owned : plant.stations()) {
    const runtime::Station& station = *owned;
    const runtime::UnitInterface& drive = station.drive();
    out += fmt::format("{}: {:04x} {:04x}", station.config().name, station.status_word_1(),
                       drive.state().outputs());
    for (const stdlib::Parameter& row : drive.parameters().table().rows())
      if (row.index != 0) out += fmt::format(" {}", drive.parameters().value(row.index));
    out += '\n';
    if (const vm::Machine* machine = station.machine()) {
      for (int n = 1; n <= vm::kContexts; ++n) {
        const vm::TaskContext& t = machine->context(n);
        out += fmt::format("[{} {} {} {}]", t.pc, t.wait_ms, static_cast<int>(t.state), t.commands);
      }
      for (const int32_t value : machine->variables()) out += fmt::format(" {}", value);
    }
    out += '\n';
  }
  for (const auto& entry : plant.journal().entries()) out += fmt::format("{} {}\n", entry.time, entry.text);
  return out;
}

// And what has passed on its buses.
struct Watched final : private runtime::BusObserver {
  explicit Watched(std::unique_ptr<runtime::Plant> made)
      : plant(std::move(made)), log(frames), serial(telegrams) {
    plant->add_observer(log);
    plant->add_observer(serial);
    for (const auto& bus : plant->buses())
      if (bus->kind() == runtime::BusKind::Profibus) bus->add_observer(*this);
  }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;
  void on_message(const runtime::Bus& bus, const runtime::BusMessage& message) override {
    telegrams << message.end << ' ' << bus.name() << ' ' << message.text << '\n';
  }
  std::unique_ptr<runtime::Plant> plant;
  std::ostringstream frames, telegrams;
  runtime::CandumpLog log;
  runtime::SerialLog serial;
};

// For ASSERT_NO_FATAL_FAILURE.
inline void expect_same(const Watched& plant, const Watched& expected, const std::string& where = {}) {
  ASSERT_EQ(picture(*plant.plant), picture(*expected.plant)) << where;
  ASSERT_EQ(plant.frames.str(), expected.frames.str()) << where;
  ASSERT_EQ(plant.telegrams.str(), expected.telegrams.str()) << where;
}

}  // namespace ipos::tests
