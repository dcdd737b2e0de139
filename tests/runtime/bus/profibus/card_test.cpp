// Option cards: switches and LEDs against the tables of the manual.
#include "runtime/bus/profibus/card.hpp"

#include "tests/runtime/bus/profibus/octets.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;

TEST(Leds, PatternsOfTheTable) {
  PROVES("DP-LED-06", "DP-LED-07", "DP-LED-08");
  CardState state;
  state.initialising = true;
  EXPECT_EQ(leds(state), (LedPattern{Light::ThreeHertz, Light::Off}));
  state.initialising = false;
  state.address_valid = false;
  EXPECT_EQ(leds(state), (LedPattern{Light::On, Light::HalfHertz}));
  state.address_valid = true;
  EXPECT_EQ(leds(state), (LedPattern{Light::On, Light::On}));
  state.exchanging = true;
  EXPECT_EQ(leds(state), (LedPattern{Light::On, Light::Off}));
  state.accessing = true;
  EXPECT_EQ(leds(state), (LedPattern{Light::Flicker, Light::Off}));
  state.accessing = false;
  // FMS alone, and both together: red where either use is missing.
  struct Use {
    UsedAs used;
    bool exchanging, connected;
    Light red;
  };
  for (const Use& use : {Use{UsedAs::Dp, false, true, Light::On}, Use{UsedAs::Dp, true, false, Light::Off},
                         Use{UsedAs::Fms, true, false, Light::On}, Use{UsedAs::Fms, false, true, Light::Off},
                         Use{UsedAs::Both, true, false, Light::On}, Use{UsedAs::Both, false, true, Light::On},
                         Use{UsedAs::Both, true, true, Light::Off}}) {
    CardState mixed;
    mixed.used_as = use.used;
    mixed.exchanging = use.exchanging;
    mixed.fms_connected = use.connected;
    EXPECT_EQ(leds(mixed), (LedPattern{Light::On, use.red}));
  }
  state.hardware = HardwareFault::GreenDark;
  EXPECT_EQ(leds(state), (LedPattern{Light::Off, Light::On}));
  state.hardware = HardwareFault::BothFlash;
  EXPECT_EQ(leds(state), (LedPattern{Light::OneHertz, Light::OneHertz}));
}

// Changes from dark to lit in ten seconds are ten times the frequency.
TEST(Leds, Frequencies) {
  const auto flashes = [](Light light) {
    int count = 0;
    bool before = is_lit(light, 10 * runtime::kSecond - 1);
    for (int ms = 0; ms < 10'000; ++ms) {
      const bool lit = is_lit(light, ms * kMillisecond);
      count += lit && !before;
      before = lit;
    }
    return count;
  };
  // A page of text tells the three rates apart (2.8).
  EXPECT_EQ(light_text(Light::HalfHertz), "flashes at 0.5 Hz");
  EXPECT_EQ(light_text(Light::OneHertz), "flashes at 1 Hz");
  EXPECT_EQ(light_text(Light::ThreeHertz), "flashes at 3 Hz");
  EXPECT_EQ(flashes(Light::HalfHertz), 5);
  EXPECT_EQ(flashes(Light::OneHertz), 10);
  EXPECT_NEAR(flashes(Light::ThreeHertz), 30, 1);
  EXPECT_EQ(flashes(Light::Flicker), 100);
  EXPECT_EQ(flashes(Light::On), 0);
  EXPECT_TRUE(is_lit(Light::On, 0));
  EXPECT_FALSE(is_lit(Light::Off, 0));
}

TEST(Switches, ActFromThePowerOnWithout24Volts) {
  PROVES("DP-ID-06");
  LatchedSwitches switches({4, false, false});
  EXPECT_EQ(switches.address(), 4);
  switches.set({7, true, true});
  EXPECT_EQ(switches.address(), 4);
  EXPECT_FALSE(switches.fms());
  EXPECT_TRUE(switches.terminated());
  switches.power_on(true);
  EXPECT_EQ(switches.address(), 4);
  EXPECT_FALSE(switches.fms());
  switches.power_on(false);
  EXPECT_EQ(switches.address(), 7);
  EXPECT_TRUE(switches.fms());
}

TEST(Switches, ChooseTheDefaultOfMinTsdr) {
  const OptionType& ffp31 = option_type(OptionKind::Ffp31);
  const OptionType& size0 = option_type(OptionKind::Size0);
  for (const BaudRate& rate : kBaudRates) {
    EXPECT_EQ(LatchedSwitches({4, false}).slave_settings(ffp31, rate.baud).min_tsdr, 11);
    EXPECT_GT(LatchedSwitches({4, true}).slave_settings(ffp31, rate.baud).min_tsdr, 11);
    EXPECT_EQ(LatchedSwitches({4, true}).slave_settings(size0, rate.baud).min_tsdr, 11);  // has no switch
  }
  EXPECT_EQ(LatchedSwitches({4}).slave_settings(ffp31, 9600).ident, 0x3100);
  EXPECT_EQ(LatchedSwitches({4}).slave_settings(size0, 9600).ident, 0x3111);
}

TEST(Options, ByWord) {
  EXPECT_EQ(option_types().size(), 5U);
  EXPECT_EQ(find_option_type("ffp31")->kind, OptionKind::Ffp31);
  EXPECT_EQ(find_option_type("size0")->ident, 0x3111);
  EXPECT_EQ(find_option_type("dfp", "mdxb")->accepts.most, 10);
  EXPECT_EQ(find_option_type("dfp", "md60a")->ident, 0x6000) << "printed for DFP11A";
  EXPECT_EQ(find_option_type("dfp", "mc07"), nullptr);
  EXPECT_EQ(find_option_type("ffp32"), nullptr);
}

// What a card accepts of configurations is what its slave accepts.
TEST(Options, AreThoseOfTheSlave) {
  const auto accepts = [](const char* word, const char* unit) {
    return LatchedSwitches({4}).slave_settings(*find_option_type(word, unit), 9600).accepts;
  };
  EXPECT_EQ(accepts("ffp31", "mc31").set, ConfigurationSet::Mc31);
  EXPECT_EQ(accepts("ffp31", "mc31").most, 3);
  EXPECT_EQ(accepts("dfp", "mdxb").set, ConfigurationSet::Movidrive);
  EXPECT_EQ(accepts("dfp", "mdxb").least, 1);
  EXPECT_EQ(accepts("dfp", "mdxb").most, 10);
  EXPECT_EQ(accepts("dfp", "md60a").most, 3);
  EXPECT_EQ(accepts("gateway", "gateway").set, ConfigurationSet::Gateway);
}

}  // namespace
}  // namespace ipos::tests
