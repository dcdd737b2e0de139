// Characters of a serial line as telegrams and numbers, and who sends what a test says.
#include "runtime/station/serial_bus.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "runtime/bus/log/serial_log.hpp"
#include "runtime/plant_file/bytes_text.hpp"
#include "runtime/plant_file/serial_plan.hpp"
#include "runtime/station/octet_faults.hpp"

namespace ipos::runtime {
namespace {

// The word bcc at the end stands for the block check.
constexpr CheckWord kBlockCheck{"bcc", block_check, 0};

}  // namespace

class SerialBus::Hand final : public SerialNode {
 public:
  explicit Hand(Rs485Line& line) : line_(line), node_(line.attach("test", line.baud(), *this)) {}
  bool send(std::span<const uint8_t> bytes) { return line_.send(node_, bytes); }

 private:
  void on_character(Time, const Character&) override {}
  void on_sent(Time) override {}

  Rs485Line& line_;
  NodeId node_;
};

SerialBus::SerialBus(BusPlace place)
    : Bus(place.config),
      queue_(place.queue),
      line_(place.queue, place.source, name(), baud()),
      check_(std::move(place.warn)) {
  line_.add_observer(check_);
}

SerialBus::~SerialBus() = default;

std::optional<std::string> SerialBus::refuse(const std::string& text) {
  if (parse_bytes(text, kBlockCheck)) return std::nullopt;
  return fmt::format("'{}' are no bytes; write for example \"02 01 85 00 06 13 88 00 00 bcc\"", text);
}

LineLoad SerialBus::load(Time now) const {
  LineLoad load = line_.load(now);
  load.frames = check_.telegrams();
  return load;
}

void SerialBus::attach_hand() {
  if (!hand_) hand_ = std::make_unique<Hand>(line_);
}

std::optional<std::string> SerialBus::send(const std::string& text) {
  if (hand_->send(*parse_bytes(text, kBlockCheck))) return std::nullopt;
  return "the telegram before is still being sent";
}

std::vector<std::string> SerialBus::findings(const PlantFile& file) const {
  std::vector<std::string> texts;
  for (SerialCableFinding& finding : serial_cable_findings(file, config())) texts.push_back(std::move(finding.text));
  return texts;
}

std::vector<FaultRule> SerialBus::fault_rules() const { return octet_fault_rules(wires()); }

FaultConfig SerialBus::make_fault(const WantedFault& wanted) const { return make_octet_fault(wanted, wires()); }

bool SerialBus::plant(const FaultConfig& config) { return plant_octet_fault(line_, config); }

bool SerialBus::repair(const FaultConfig& config) {
  return line_.end_fault(config.octets->kind, node_named(line_, config.station));
}

void SerialBus::on_character(const Rs485Line&, NodeId sender, const Character& character) {
  trace_all(sender, character.start, character.end, character.data, character.parity_error,
            character.framing_error);
  if (is_observed()) tell_reception(receiver_.take(character));
}

void SerialBus::on_serial_event(const Rs485Line&, const SerialEvent& event) {
  trace_all(event.kind, event.time, event.node, event.other);
}

void SerialBus::finish() { tell_reception(receiver_.give_up()); }

void SerialBus::tell_reception(const std::optional<Reception>& reception) {
  if (!reception) return;
  const auto bytes = reception->bytes.span();
  tell({reception->end,
        fmt::format("{:02X}", fmt::join(bytes, " ")),
        reception_text(*reception),
        {bytes.begin(), bytes.end()}});
}

IPOS_MAKES_BUS(SerialBus)

}  // namespace ipos::runtime
