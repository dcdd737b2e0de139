// What a fault does: each response P830..P837 on each fault it belongs to, resets, auto reset, and two faults
// at once (1053 1610 p. 27, 81; rules in runtime/drive/fault_state.hpp).
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

constexpr int kRapidMs = 600;       // P136
constexpr int kEmergencyMs = 1200;  // P137
constexpr int kBrakeMs = 50;        // P732

bool is_error(int response) { return response >= 2 && response <= 4; }
bool is_warning_with_stop(int response) { return response >= 5; }
// Time from 1000 rpm to standstill; -1: goes on, 0: output stage off at once.
int stop_ms(int response) {
  switch (response) {
    case 2:
    case 5: return 0;
    case 3:
    case 6: return mdx_ramp_ms(1000, kEmergencyMs);
    case 4:
    case 7: return mdx_ramp_ms(1000, kRapidMs);
    default: return -1;
  }
}

struct FaultRig : DriveRig {
  explicit FaultRig(const MachineData& machine = light_machine()) : DriveRig("md60a", {}, machine) {
    enable_terminals();
    set("P131", 4000);
    set("P136", kRapidMs);
    set("P137", kEmergencyMs);
    set("P732", kBrakeMs);
    set("P604", 12);  // DI05 ERROR RESET
    set("P603", 11);  // DI04 /EXT. ERROR
    input("DI04", true);
  }
  void over(PoSource source, int32_t p100) {
    set("P100", p100);
    po({0x0006, 5000, 0}, source);
    settle();
    EXPECT_EQ(rpm(), 1000);
  }
};

// A fault that has a parameter for its response: how it comes and goes while the drive turns with 1000 rpm.
struct Case {
  const char* name;
  int number;
  const char* parameter;
  void (*run)(FaultRig&);
  void (*cause)(FaultRig&);
  void (*end)(FaultRig&);
};
const Case kCases[] = {
    {"external fault", 26, "P830", [](FaultRig& rig) { rig.over(PoSource::Sbus, 10); },
     [](FaultRig& rig) { rig.input("DI04", false); }, [](FaultRig& rig) { rig.input("DI04", true); }},
    {"fieldbus timeout", 28, "P831", [](FaultRig& rig) { rig.over(PoSource::Fieldbus, 3); },
     [](FaultRig& rig) { rig.silence(); },
     [](FaultRig& rig) {
       rig.po({0x0006, 5000, 0}, PoSource::Fieldbus);
     }},
    {"RS-485 timeout", 43, "P833",
     [](FaultRig& rig) {
       rig.set("P812", 100);
       rig.over(PoSource::Rs485, 2);
     },
     [](FaultRig& rig) { rig.silence(); },
     [](FaultRig& rig) {
       rig.po({0x0006, 5000, 0}, PoSource::Rs485);
     }},
    {"SBus timeout", 47, "P836",
     [](FaultRig& rig) {
       rig.set("P815", 100);
       rig.over(PoSource::Sbus, 10);
     },
     [](FaultRig& rig) { rig.silence(); },
     [](FaultRig& rig) {
       rig.po({0x0006, 5000, 0}, PoSource::Sbus);
     }},
};

TEST(FaultResponse, EveryResponseOfEveryFault) {
  PROVES("DRV-17");
  for (const Case& fault : kCases)
    for (int32_t response = 0; response <= 7; ++response) {
      SCOPED_TRACE(std::string(fault.name) + ", response " + std::to_string(response));
      FaultRig rig;
      rig.set(fault.parameter, response);
      fault.run(rig);
      fault.cause(rig);
      const bool shown = response != 0;
      if (shown) {
        EXPECT_LE(rig.ms_until([&] { return rig.drive.fault() != 0; }), 520);
      } else {
        rig.run_ms(600);
      }

      // Status word, display, unit condition.
      EXPECT_EQ(rig.drive.fault(), shown ? fault.number : 0);
      EXPECT_EQ(rig.status() >> 8, shown ? fault.number : 4);
      EXPECT_EQ((rig.status() & 0x20) != 0, shown);
      EXPECT_EQ((rig.status() & 0x02) != 0, !is_error(response));
      EXPECT_EQ(rig.drive.display(), shown ? 'F' : '4');
      const UnitCondition condition = is_error(response) ? UnitCondition::NotReady
                                      : response == 5    ? UnitCondition::ControllerInhibit
                                      : response >= 6    ? UnitCondition::NoEnable
                                                         : UnitCondition::Enable;
      EXPECT_EQ(rig.drive.condition(), condition);
      EXPECT_EQ(rig.output("DO02"), !is_error(response)) << "P621 = /ERROR";

      // The stop: output stage, brake, time.
      const int stop = stop_ms(response);
      EXPECT_EQ(rig.stage(), stop != 0);
      EXPECT_EQ(rig.status() & 1, stop != 0 ? 1 : 0);
      EXPECT_EQ(rig.brake_released(), stop != 0);
      if (stop > 0) {
        EXPECT_NEAR(1 + rig.ms_until_standing(), stop, 2);
        rig.run_ms(kBrakeMs / 2);
        EXPECT_FALSE(rig.brake_released());
        EXPECT_TRUE(rig.stage()) << "until the brake is in";
        rig.run_ms(kBrakeMs);
      } else {
        rig.run_ms(1000);
      }
      EXPECT_EQ(rig.stage(), stop < 0);
      EXPECT_EQ(rig.rpm(), stop < 0 ? 1000 : 0);
      EXPECT_EQ(rig.output("DB00"), stop < 0);

      // Error memory: warnings pass by it (ours).
      EXPECT_EQ(rig.value("P080"), is_error(response) ? fault.number : 0);

      // The cause goes.
      fault.end(rig);
      rig.run_ms(3000);
      EXPECT_EQ(rig.drive.fault(), is_error(response) || response == 1 ? fault.number : 0);
      EXPECT_EQ(rig.rpm(), is_error(response) ? 0 : 1000);
      if (is_error(response)) {
        EXPECT_FALSE(rig.stage());
      }
      rig.drive.reset_fault();
      rig.run_ms(3000);
      EXPECT_EQ(rig.drive.fault(), 0);
      EXPECT_EQ(rig.rpm(), 1000);
      EXPECT_EQ(rig.status() >> 8, 4);
    }
}

// F31, F42, F46 have no cause in this drive yet (docs/reference/limits.md); a fault of the program or of another part
// is raised from outside. F84 is driven by the load in MotorOverload.
TEST(FaultResponse, RaisedFromOutside) {
  for (const auto& [unit_name, number, parameter] :
       {std::tuple{"md60a", 31, "P835"}, {"md60a", 42, "P834"}, {"md60a", 84, "P832"}, {"mdxb", 46, "P837"}})
    for (int32_t response = 0; response <= 7; ++response) {
      SCOPED_TRACE(std::string(parameter) + " = " + std::to_string(response));
      DriveRig rig(unit_name);
      rig.set(parameter, response);
      rig.set("P136", kRapidMs);
      rig.set("P137", kEmergencyMs);
      rig.bus_control();
      rig.po({0x0006, 5000, 0});
      rig.settle();
      rig.drive.raise_fault(static_cast<uint8_t>(number));
      EXPECT_EQ(rig.drive.fault(), response == 0 ? 0 : number);
      EXPECT_EQ(rig.drive.error(), is_error(response));
      const runtime::Command want = stop_ms(response) < 0            ? runtime::Command::Enable
                                    : stop_ms(response) == 0         ? runtime::Command::Inhibit
                                    : response == 3 || response == 6 ? runtime::Command::EmergencyStop
                                                                     : runtime::Command::RapidStop;
      EXPECT_EQ(rig.drive.verdict().command, want);
      if (!is_error(response)) continue;
      EXPECT_NEAR(rig.ms_until_standing(), stop_ms(response) > 0 ? stop_ms(response) : 17, 18);
      EXPECT_EQ(rig.drive.fault(), number);
    }
}

TEST(FaultResponse, MotorOverload) {
  PROVES("DRV-19");
  for (int32_t response = 0; response <= 7; ++response) {
    // 120 % load make 113 % of the rated current, so 128 % heat in the long run; the motor cools slowly
    // enough for the stop.
    MachineData machine = light_machine();
    machine.load_torque = 120'000;
    machine.motor_heat_time_ms = 10'000;
    FaultRig rig(machine);
    rig.set("P500", 0);
    rig.set("P832", response);
    rig.over(PoSource::Sbus, 10);
    rig.run_ms(60'000);
    EXPECT_EQ(rig.drive.fault(), 0) << "P340 = OFF";
    EXPECT_NEAR(rig.value("P006"), 128'000, 2'000);
    rig.set("P340", 1);
    rig.run_ms(1);
    EXPECT_EQ(rig.drive.fault(), response == 0 ? 0 : 84) << response;
    EXPECT_EQ(rig.drive.error(), is_error(response)) << response;
    const int stop = stop_ms(response);
    EXPECT_EQ(rig.stage(), stop != 0) << response;
    if (stop > 0) {
      EXPECT_NEAR(1 + rig.ms_until_standing(), stop, 2) << response;
    }
    rig.run_ms(1000);
    EXPECT_EQ(rig.rpm(), stop < 0 ? 1000 : 0) << response;
  }
}

TEST(FaultResponse, Movitrac07HasTwoForExternalFaultsOnly) {
  for (const auto& [p830, stop] : {std::pair{2, 0}, {4, m07_ramp_ms(1000, 600)}}) {
    DriveRig rig("mc07");
    rig.bus_control();
    rig.set("P136", 600);
    rig.set("P830", p830);
    rig.set("P603", 11);  // DI04 EXT. FAULT
    rig.input("DI04", true);
    rig.po({0x0006, 5000, 0});
    rig.settle();
    rig.input("DI04", false);
    rig.run_ms(1);
    EXPECT_EQ(rig.drive.fault(), 26);
    EXPECT_TRUE(rig.drive.error());
    EXPECT_EQ(rig.stage(), stop != 0);
    if (stop > 0) {
      EXPECT_NEAR(1 + rig.ms_until_standing(), stop, 2);
    }
  }
  DriveRig tf("mc07");
  tf.bus_control();
  tf.set("P136", 600);
  tf.set("P604", 26);  // DI05 TF SIGNAL
  tf.input("DI05", true);
  tf.po({0x0006, 5000, 0});
  tf.settle();
  tf.input("DI05", false);
  tf.run_ms(1);
  EXPECT_EQ(tf.drive.fault(), 31);
  EXPECT_NEAR(1 + tf.ms_until_standing(), m07_ramp_ms(1000, 600), 2);
}

TEST(FaultReset, EveryWay) {
  for (const char* way : {"input", "bus", "P840", "program", "drive"}) {
    SCOPED_TRACE(way);
    FaultRig rig;
    rig.set("P101", 3);
    rig.over(PoSource::Sbus, 10);
    rig.drive.raise_fault(1);
    rig.run_ms(100);
    EXPECT_EQ(rig.drive.fault(), 1);
    const std::string name = way;
    if (name == "input") rig.input("DI05", true);
    if (name == "bus") rig.po({0x0046, 5000, 0});
    if (name == "P840") {
      EXPECT_EQ(rig.write("P840", 1), 0);
    }
    if (name == "program") rig.program_word(1U << 12);
    if (name == "drive") rig.drive.reset_fault();
    rig.run_ms(1);
    EXPECT_EQ(rig.drive.fault(), 0);
    rig.run_ms(3000);
    EXPECT_EQ(rig.rpm(), 1000);
    EXPECT_EQ(rig.value("P840"), 0);
    // A level that stays is no second reset.
    rig.drive.raise_fault(1);
    rig.run_ms(1000);
    EXPECT_EQ(rig.drive.fault(), 1);
  }
}

TEST(FaultReset, WithTheCauseStillThereItComesBack) {
  FaultRig rig;
  rig.over(PoSource::Sbus, 10);
  rig.input("DI04", false);
  rig.run_ms(1000);
  rig.drive.reset_fault();
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.fault(), 26);
  EXPECT_EQ(rig.rpm(), 0);
  EXPECT_EQ(rig.value("P081"), 26) << "a second entry of the error memory";
}

// P841, P842. That three attempts are made until somebody resets by hand is ours.
TEST(FaultReset, AutoReset) {
  PROVES("DRV-18");
  FaultRig rig;
  rig.set("P841", 1);
  rig.set("P842", 2000);
  rig.over(PoSource::Sbus, 10);
  for (int n = 0; n < 3; ++n) {
    rig.drive.raise_fault(1);
    EXPECT_NEAR(rig.ms_until([&] { return rig.drive.fault() == 0; }), 2000, 1) << n;
    rig.run_ms(2000);
    EXPECT_EQ(rig.rpm(), 1000);
  }
  rig.drive.raise_fault(1);
  rig.run_ms(20'000);
  EXPECT_EQ(rig.drive.fault(), 1);
  rig.input("DI05", true);
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.fault(), 0);
  rig.drive.raise_fault(1);
  rig.run_ms(2001);
  EXPECT_EQ(rig.drive.fault(), 0) << "counted anew";
  // By the bus, too.
  for (int n = 0; n < 3; ++n) {
    rig.drive.raise_fault(1);
    rig.run_ms(2500);
  }
  rig.set("P101", 3);
  rig.po({0x0046, 5000, 0});
  rig.drive.raise_fault(1);
  rig.run_ms(2001);
  EXPECT_EQ(rig.drive.fault(), 0);
  FaultRig off;
  off.drive.raise_fault(1);
  off.run_ms(60'000);
  EXPECT_EQ(off.drive.fault(), 1);
}

// --- two at once ---

// The rules of fault_state.hpp, written down a second time over a plain list in order of arrival.
struct Model {
  struct Pending {
    int number;
    int response;
  };
  std::vector<Pending> list;

  bool error() const {
    return std::any_of(list.begin(), list.end(), [](const Pending& p) { return is_error(p.response); });
  }
  void raise(int number, int response) {
    if (response == 0) return;
    for (const Pending& p : list)
      if (p.number == number) return;
    if (is_error(response) && error()) return;  // the first error stays the only one
    list.push_back({number, response});
  }
  void clear(int number) {
    std::erase_if(list,
                  [&](const Pending& p) { return p.number == number && is_warning_with_stop(p.response); });
  }
  void reset() {
    std::erase_if(list, [](const Pending& p) { return !is_warning_with_stop(p.response); });
  }
  int shown() const {
    for (const Pending& p : list)
      if (is_error(p.response)) return p.number;
    return list.empty() ? 0 : list[0].number;
  }
  int hardest() const {  // 0 none, 1 rapid, 2 emergency, 3 immediate
    constexpr int kHardness[] = {0, 0, 3, 2, 1, 3, 2, 1};
    int most = 0;
    for (const Pending& p : list) most = std::max(most, kHardness[p.response]);
    return most;
  }
};

TEST(FaultPairs, EverySequenceOfFiveEvents) {
  int64_t sequences = 0;
  for (int a = 0; a <= 7; ++a)
    for (int b = 0; b <= 7; ++b)
      for (int code = 0; code < 5 * 5 * 5 * 5 * 5; ++code) {
        runtime::FaultState state;
        Model model;
        for (int left = code, n = 0; n < 5; left /= 5, ++n) {
          switch (left % 5) {
            case 0:
              state.raise(26, static_cast<FaultResponse>(a));
              model.raise(26, a);
              break;
            case 1:
              state.raise(47, static_cast<FaultResponse>(b));
              model.raise(47, b);
              break;
            case 2:
              state.clear_cause(26);
              model.clear(26);
              break;
            case 3:
              state.clear_cause(47);
              model.clear(47);
              break;
            case 4:
              state.reset();
              model.reset();
              break;
          }
          ASSERT_EQ(state.shown(), model.shown()) << a << b << " " << code;
          ASSERT_EQ(state.error(), model.error()) << a << b << " " << code;
          ASSERT_EQ(state.warning(), !model.error() && model.shown() != 0) << a << b << " " << code;
          ASSERT_EQ(static_cast<int>(state.stop()), model.hardest()) << a << b << " " << code;
        }
        ++sequences;
      }
  std::printf("%lld sequences\n", static_cast<long long>(sequences));
}

TEST(FaultPairs, TheHardestStopActs) {
  for (int32_t external = 0; external <= 7; ++external)
    for (int32_t timeout = 0; timeout <= 7; ++timeout) {
      SCOPED_TRACE(std::to_string(external) + " " + std::to_string(timeout));
      FaultRig rig;
      rig.set("P830", external);
      rig.set("P836", timeout);
      rig.set("P815", 100);
      rig.over(PoSource::Sbus, 10);
      // The external fault comes in the millisecond in which the timeout runs out.
      rig.silence();
      rig.drive.take_po(PoSource::Sbus, Words{0x0006, 5000, 0});
      rig.run_ms(100);
      rig.input("DI04", false);
      rig.run_ms(1);
      Model model;
      model.raise(47, timeout);  // links are watched first
      model.raise(26, external);
      EXPECT_EQ(rig.drive.fault(), model.shown());
      EXPECT_EQ(rig.drive.error(), model.error());
      const int hardest = model.hardest();
      EXPECT_EQ(rig.stage(), hardest != 3);
      if (hardest == 1 || hardest == 2) {
        EXPECT_NEAR(1 + rig.ms_until_standing(), mdx_ramp_ms(1000, hardest == 1 ? kRapidMs : kEmergencyMs),
                    2);
      }
      rig.run_ms(500);
      EXPECT_EQ(rig.rpm(), hardest == 0 ? 1000 : 0);
      // Both causes gone, then a reset: it runs again, whatever it was.
      rig.input("DI04", true);
      rig.po({0x0006, 5000, 0});
      rig.run_ms(20);
      rig.drive.reset_fault();
      rig.run_ms(3000);
      EXPECT_EQ(rig.drive.fault(), 0);
      EXPECT_EQ(rig.rpm(), 1000);
    }
}

// The column "parameter" of the table of faults, docs/inside/drive.md: _FaultReaction alone chooses for these four. The
// others keep the response of their parameter or their fixed one.
TEST(FaultResponse, ByCommandOnlyWhereTheTableSaysSo) {
  const auto by_command = [](int number) {
    return number == 39 || number == 77 || number == 78 || number == 123;
  };
  for (int number = 0; number <= 255; ++number) {
    FaultRig rig;
    EXPECT_EQ(rig.drive.set_fault_response(static_cast<uint8_t>(number), FaultResponse{3}),
              by_command(number))
        << "F" << number;
  }
  for (const int number : {39, 77, 78, 123})
    for (uint8_t response = 0; response <= 7; ++response) {
      FaultRig rig;
      EXPECT_TRUE(rig.drive.set_fault_response(static_cast<uint8_t>(number), FaultResponse{response}));
      rig.drive.raise_fault(static_cast<uint8_t>(number));
      EXPECT_EQ(rig.drive.fault(), response == 0 ? 0 : number) << int{response};
      EXPECT_EQ(rig.drive.error(), is_error(response)) << "F" << number << " " << int{response};
    }
  // Those with the fixed response of an error cannot be silenced.
  for (const uint8_t number : std::initializer_list<uint8_t>{1, 7, 8, 10, 11, 25, 27, 29, 32, 41, 94, 99}) {
    FaultRig rig;
    EXPECT_FALSE(rig.drive.set_fault_response(number, FaultResponse{0}));
    rig.drive.raise_fault(number);
    EXPECT_EQ(rig.drive.fault(), number);
    EXPECT_TRUE(rig.drive.error()) << "F" << int{number};
  }
}

}  // namespace
}  // namespace ipos::tests
