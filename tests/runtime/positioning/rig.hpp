// A drive with positioning and its variables, ticked as a station does it, on a machine whose switches stand
// at mechanical positions.
#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "runtime/services/positioning_service.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::tests {

using runtime::Positioner;

// Terminals of the rig: DI00 /inhibit, DI01 CW, DI03 enable as from the factory.
inline constexpr uint16_t kEnabled = 0b1011;

struct Rig {
  using Settings = std::initializer_list<std::pair<const char*, int32_t>>;

  // CFC & IPOS without premagnetization unless said otherwise.
  explicit Rig(Settings settings = {}, const char* unit = "md60a", const runtime::MachineData& machine = {})
      : parameters(*stdlib::find_unit(unit)),
        drive(parameters, machine),
        service(milliseconds, drive, parameters, journal, "rig", [](uint32_t) { return std::string(); }) {
    set("700", 13);
    set("323", 0);
    for (const auto& [number, value] : settings) set(number, value);
    drive.set_inputs(kEnabled);
    run(3);
  }

  void set(const char* number, int32_t value) {
    const auto* row = parameters.table().find(number);
    ASSERT_NE(row, nullptr) << number;
    ASSERT_TRUE(parameters.preset(row->index, value)) << number << " := " << value;
  }

  void tick() {
    if (levels) drive.set_inputs(levels(mechanical));
    const auto control = service.order(now, h, 0);
    const int32_t before = drive.axis().position;
    drive.tick(control);
    mechanical += runtime::wrapped(int64_t{drive.axis().position} - before);
    service.observe();
    service.show(now, h);
    now += runtime::kMillisecond;
    ++ms;
  }
  void run(int count) {
    while (count-- > 0) tick();
  }
  // How many ms it took; fails when it takes too long.
  int run_until(const std::function<bool()>& condition, int limit = 60'000) {
    int count = 0;
    while (!condition()) {
      if (++count > limit) {
        ADD_FAILURE() << "has not happened within " << limit << " ms";
        return count;
      }
      tick();
    }
    return count;
  }
  bool arrived() const {
    return h[491] == h[492] && h[511] == h[492] && drive.axis().standing && in_position();
  }
  bool arrived_external() const { return h[491] == h[492] && h[510] == h[492] && drive.axis().standing; }
  int run_to_target(int limit = 60'000) {
    return run_until([&] { return arrived(); }, limit);
  }

  // What the commands do with their keywords.
  void go(int32_t target) {
    service.take_targets(h);
    service.change_positioner().write_target(target);
    service.show_targets(h);
  }
  void go_by(int32_t way) {
    service.take_targets(h);
    service.change_positioner().move_target(way);
    service.show_targets(h);
  }
  Positioner& positioner() { return service.change_positioner(); }

  bool in_position() const { return (h[473] >> 19 & 1) != 0; }
  bool referenced() const { return (h[473] >> 20 & 1) != 0; }
  bool said(const std::string& text) const {
    for (const auto& entry : journal.entries())
      if (entry.text.find(text) != std::string::npos) return true;
    return false;
  }

  runtime::ParameterStore parameters;
  runtime::Drive drive;
  runtime::Journal journal;
  runtime::OwnMilliseconds milliseconds;
  runtime::PositioningService service;
  std::array<int32_t, 512> h{};
  // Levels of the inputs at a mechanical position; without it they stay as set.
  std::function<uint16_t(int64_t)> levels;
  int64_t mechanical = 0;  // increments of the motor since power-on
  runtime::Time now = 0;
  int ms = 0;
};

}  // namespace ipos::tests
