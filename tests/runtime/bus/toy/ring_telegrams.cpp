// The signals of a ring: the value and the count of what has come to each address.
#include <charconv>

#include "runtime/signals/telegram_lines.hpp"
#include "tests/runtime/bus/toy/ring_bus.hpp"

namespace ipos::signals {

using namespace runtime;  // NOLINT

namespace {

class RingTelegrams final : public TelegramLine {
 public:
  explicit RingTelegrams(RingBus& bus) : bus_(bus) {}

  const runtime::Bus& bus() const override { return bus_; }
  std::vector<Signal> listed() const override {
    std::vector<Signal> all;
    for (size_t to = 0; to < bus_.node_names().size(); ++to)
      for (Signal& signal : all_of(std::to_string(to))) all.push_back(std::move(signal));
    return all;
  }
  std::optional<std::string> identity(std::string_view text) const override {
    const auto to = number_of(text);
    return to ? std::optional(std::to_string(*to)) : std::nullopt;
  }
  std::vector<Signal> all_of(std::string_view identity) const override {
    const uint8_t to = *number_of(identity);
    std::vector<Signal> made{telegram_signal(bus_, identity, "value", "of the last telegram to it", 8),
                                  telegram_signal(bus_, identity, "count", "telegrams to it", 0)};
    made[0].read = [&bus = bus_, to]() -> int64_t { return bus.arrived(to).last.value; };
    made[1].read = [&bus = bus_, to] { return static_cast<int64_t>(bus.arrived(to).count); };
    return made;
  }

 private:
  static std::optional<uint8_t> number_of(std::string_view text) {
    uint8_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
  }

  RingBus& bus_;
};

}  // namespace

std::unique_ptr<TelegramLine> telegrams_of(const PlantParts&, RingBus& bus) {
  return std::make_unique<RingTelegrams>(bus);
}

}  // namespace ipos::signals
