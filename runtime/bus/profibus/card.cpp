// Tables and rules of the option card.
#include "runtime/bus/profibus/card.hpp"

namespace ipos::profibus {
namespace {

constexpr OptionType kOptions[] = {
#define PROFIBUS_OPTION(name, word, unit, ident, fms, set, most_words, model, gsd_file) \
  {OptionKind::name, word, unit, ident, fms, {ConfigurationSet::set, 1, most_words}, model, gsd_file},
#include "runtime/bus/profibus/options.def"
};

bool in_use(const CardState& state) {
  switch (state.used_as) {
    case UsedAs::Dp: return state.exchanging;
    case UsedAs::Fms: return state.fms_connected;
    case UsedAs::Both: break;
  }
  return state.exchanging && state.fms_connected;
}

// On for the first half of each period.
bool flashes(Time now, Time period) { return now % period < period / 2; }

}  // namespace

std::span<const OptionType> option_types() { return kOptions; }
const OptionType& option_type(OptionKind kind) { return kOptions[static_cast<size_t>(kind)]; }

const OptionType* find_option_type(std::string_view word, std::string_view unit) {
  for (const OptionType& option : kOptions)
    if (option.word == word && (unit.empty() || option.unit == unit)) return &option;
  return nullptr;
}

SlaveSettings LatchedSwitches::slave_settings(const OptionType& option, uint32_t baud) const {
  SlaveSettings settings{address(), option.ident};
  settings.accepts = option.accepts;
  const BaudRate* rate = find_baud_rate(baud);
  if (option.fms && fms() && rate != nullptr) settings.min_tsdr = rate->fms_min_tsdr;
  return settings;
}

LedPattern leds(const CardState& state) {
  if (state.hardware == HardwareFault::GreenDark) return {Light::Off, Light::On};
  if (state.hardware == HardwareFault::BothFlash) return {Light::OneHertz, Light::OneHertz};
  if (state.initialising) return {Light::ThreeHertz, Light::Off};
  if (!state.address_valid) return {Light::On, Light::HalfHertz};
  return {state.accessing ? Light::Flicker : Light::On, in_use(state) ? Light::Off : Light::On};
}

std::string_view light_text(Light light) {
  switch (light) {
    case Light::Off: return "off";
    case Light::On: return "on";
    case Light::HalfHertz: return "flashes at 0.5 Hz";
    case Light::OneHertz: return "flashes at 1 Hz";
    case Light::ThreeHertz: return "flashes at 3 Hz";
    case Light::Flicker: break;
  }
  return "flickers";
}

bool is_lit(Light light, Time now) {
  const int rate = light_rate(light);
  return rate == 0 ? light == Light::On : flashes(now, 10 * runtime::kSecond / rate);
}

}  // namespace ipos::profibus
