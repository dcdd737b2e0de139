// Frames of a CAN line as messages and numbers, and who sends what a test says.
#include "runtime/station/can_bus.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "runtime/bus/log/candump.hpp"
#include "runtime/plant_file/can_cable.hpp"

namespace ipos::runtime {
namespace {

tl::expected<LogEntry, LogError> parse_can_text(const std::string& text) {
  return parse_candump_line("(0946684800.000000) bus " + text);
}

}  // namespace

class CanBus::Hand final : public CanNode {
 public:
  explicit Hand(CanLine& line) : line_(line), node_(line.attach("test", line.baud(), *this)) {}

  std::optional<std::string> send(const Frame& frame) {
    const SendStatus status = line_.send(node_, frame, 0);
    if (status == SendStatus::Queued) return std::nullopt;
    return status == SendStatus::QueueFull ? "too many frames wait to be sent" : "the bus is off";
  }

 private:
  void on_frame(Time, const Frame&) override {}
  void on_sent(Time, const Frame&, uint64_t) override {}
  bool minds_repeats() const override { return false; }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  void on_bus_off(Time) override { line_.recover(node_); }

  CanLine& line_;
  NodeId node_;
};

// What happens to the line goes to the journal.
class CanBus::Reports final : public LineObserver {
 public:
  explicit Reports(CanBus& bus) : bus_(bus) { bus.line_.add_observer(*this); }

 private:
  void on_line_event(const CanLine& line, const LineEvent& event) override {
    bus_.place_.warn(event.time, describe(line, event));
  }

  CanBus& bus_;
};

CanBus::CanBus(BusPlace place)
    : Bus(place.config),
      place_(std::move(place)),
      line_(place_.queue, place_.source, name(), baud()),
      reports_(std::make_unique<Reports>(*this)),
      check_(static_cast<SbusCheckClient&>(*this), !place_.config.port.empty()) {
  line_.add_observer(check_);
}

CanBus::~CanBus() = default;

std::optional<std::string> CanBus::refuse(const std::string& text) {
  const auto entry = parse_can_text(text);
  if (entry) return std::nullopt;
  return fmt::format("'{}' is no frame: {}; write for example \"20B#3100207E00000000\"", text,
                     entry.error().message);
}

void CanBus::attach_hand() {
  if (!hand_) hand_ = std::make_unique<Hand>(line_);
}

std::optional<std::string> CanBus::send(const std::string& text) {
  return hand_->send(parse_can_text(text)->frame);
}

NodeId CanBus::find_node(const std::string& station) const {
  for (NodeId node = 0; node < line_.node_count() && !station.empty(); ++node)
    if (line_.node_name(node) == station) return node;
  return kNoNode;
}

std::vector<std::string> CanBus::findings(const PlantFile& file) const {
  std::vector<std::string> texts;
  for (CableFinding& finding : can_cable_findings(file, config())) texts.push_back(std::move(finding.text));
  return texts;
}

std::vector<FaultRule> CanBus::fault_rules() const {
  std::vector<FaultRule> rules;
  for (const FaultType& type : kFaultTypes) {
    const bool of_frames = type.scope == FaultScope::Frame;
    rules.push_back({type.word, type.text, type.at, of_frames, of_frames});
  }
  return rules;
}

FaultConfig CanBus::make_fault(const WantedFault& wanted) const {
  FaultConfig config;
  config.fault.kind = find_fault_type(wanted.word)->kind;
  config.fault.per_mille = wanted.per_mille;
  config.fault.from = wanted.from;
  config.fault.id = wanted.id;
  config.fault.of_line = wanted.of_line;
  if (config.fault.kind == FaultKind::Delay) config.fault.lag = kMillisecond;
  if (config.fault.kind == FaultKind::Baud) config.fault.baud = baud() == kBaudRates[0] ? kBaudRates[1] : baud() / 2;
  return config;
}

bool CanBus::plant(const FaultConfig& config) {
  LineFault fault = config.fault;
  fault.node = find_node(config.station);
  if (!config.station.empty() && fault.node == kNoNode) return false;
  line_.plant(fault);
  return true;
}

bool CanBus::repair(const FaultConfig& config) {
  LineFault fault = config.fault;
  fault.node = find_node(config.station);
  return line_.repair(fault);
}

void CanBus::on_frame(const CanLine&, const FrameRecord& record) {
  const Frame& frame = record.frame;
  std::array<uint64_t, 6 + 8> facts = {record.sender,
                                       static_cast<uint64_t>(record.start),
                                       static_cast<uint64_t>(record.end),
                                       record.bits,
                                       frame.id,
                                       frame.length};
  for (size_t n = 0; n < frame.length; ++n) facts[6 + n] = frame.data[n];
  trace(std::span(facts).first(6U + frame.length));
  if (!is_observed()) return;
  const std::string text = candump_line(record.end, name(), frame);
  const auto length = static_cast<std::ptrdiff_t>(frame.remote ? 0 : frame.length);
  tell({record.end,
        text.substr(text.rfind(' ') + 1),
        {},
        {frame.data.begin(), frame.data.begin() + length},
        frame});
}

void CanBus::on_line_event(const CanLine&, const LineEvent& event) {
  trace_all(event.kind, event.time, event.node, event.other, event.id, event.fault);
}

IPOS_MAKES_BUS(CanBus)

}  // namespace ipos::runtime
