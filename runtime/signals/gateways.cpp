// One row a value.
#include "runtime/signals/gateways.hpp"

#include <fmt/format.h>

#include <utility>

namespace ipos::signals {

using namespace runtime;

namespace {

constexpr size_t kGatewayWordBits = 16, kLostBits = 8, kReturnCodeBits = 32;

class GatewayCollector {
 public:
  explicit GatewayCollector(const Gateway& gateway) : gateway_(gateway) {}

  // `read` is given the gateway.
  template <typename Read>
  void add(Group group, std::string_view name, std::string_view meaning, size_t bits, Read read) {
    Signal& signal = found.emplace_back();
    signal.station = gateway_.config().name;
    signal.name = fmt::format("{}.{}", signal.station, name);
    signal.group = group;
    signal.meaning = meaning;
    signal.bits = bits;
    signal.read = [&gateway = gateway_, read]() -> int64_t { return static_cast<int64_t>(read(gateway)); };
  }

  std::vector<Signal> found;

 private:
  const Gateway& gateway_;
};

void add_drive(size_t n, int address, GatewayCollector& out) {
  const auto name = [address](std::string_view own) { return fmt::format("drive{}.{}", address, own); };
  for (size_t word = 0; word < std::tuple_size_v<ProcessWords>; ++word)
    out.add(Group::ProcessData, name(fmt::format("PO{}", word + 1)), "sent to the drive", kGatewayWordBits,
            [n, word](const Gateway& gateway) { return gateway.drive(n).output[word]; });
  for (size_t word = 0; word < std::tuple_size_v<ProcessWords>; ++word)
    out.add(Group::ProcessData, name(fmt::format("PI{}", word + 1)), "for the DP master; 0 while the drive is lost",
            kGatewayWordBits, [n, word](const Gateway& gateway) { return gateway.input(n)[word]; });
  out.add(Group::State, name("lost"), "1 while the drive does not answer", 1,
          [n](const Gateway& gateway) { return gateway.drive(n).lost ? 1 : 0; });
  out.add(Group::State, name("losses"), "how often it was lost", 0,
          [n](const Gateway& gateway) { return gateway.drive(n).losses; });
  out.add(Group::State, name("asked"), "PO telegrams sent to it", 0,
          [n](const Gateway& gateway) { return gateway.drive(n).answers.asked; });
  out.add(Group::State, name("answered"), "PI telegrams of it", 0,
          [n](const Gateway& gateway) { return gateway.drive(n).answers.answered; });
}

}  // namespace

std::vector<Signal> gateway_signals(const Gateway& gateway) {
  GatewayCollector all(gateway);
  all.add(Group::State, "powered", "1 while the power is on", 1,
          [](const Gateway& of) { return of.powered() ? 1 : 0; });
  all.add(Group::State, "exchange", "1 while its DP master exchanges data with it", 1,
          [](const Gateway& of) { return of.exchanges() ? 1 : 0; });
  all.add(Group::State, "lost", "a bit for each drive that does not answer, the lowest address in bit 0", kLostBits,
          [](const Gateway& of) { return of.lost(); });
  all.add(Group::State, "error", "return code of the last service of the parameter channel; 0 is good", kReturnCodeBits,
          [](const Gateway& of) { return of.channel().error(); });
  for (size_t n = 0; n < gateway.drive_count(); ++n) add_drive(n, gateway.drive(n).address, all);
  return std::move(all.found);
}

}  // namespace ipos::signals
